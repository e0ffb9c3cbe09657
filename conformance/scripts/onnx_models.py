"""Writes the small ONNX models in tests/data/policies, which test policies from files.

    pip install onnx numpy && python conformance/scripts/onnx_models.py

Weights are formulas that the test repeats. Sizes are those of `tests/policies.rs`: 47 joint angles, 6 vestibular numbers,
eyes of 8 x 8 pixels, 6 actions.
"""

from pathlib import Path

import numpy as np
from onnx import TensorProto, checker, helper, numpy_helper, save

OUT = Path(__file__).resolve().parents[2] / "tests" / "data" / "policies"
ANGLES, BALANCE, SIDE, ACTIONS = 47, 6, 8, 6
FLOAT, BYTE, LONG = TensorProto.FLOAT, TensorProto.UINT8, TensorProto.INT64


def value(name, shape, kind=FLOAT):
    return helper.make_tensor_value_info(name, kind, shape)


def constant(name, array):
    return numpy_helper.from_array(np.asarray(array), name)


def write(name, nodes, inputs, outputs, constants=()):
    graph = helper.make_graph(nodes, name, inputs, outputs, list(constants))
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], producer_name="babybench")
    model.ir_version = 8
    checker.check_model(model, full_check=True)
    save(model, OUT / f"{name}.onnx")


def weights(rows, columns):
    i, j = np.indices((rows, columns))
    return (((7 * i + 3 * j) % 11 - 5) / 64).astype(np.float32)


def bias(columns):
    return (np.arange(columns) / 16).astype(np.float32)


def network(name, batch, observation="observation", angles=ANGLES, actions=ACTIONS):
    """tanh((observation, vestibular) W + b): two inputs, like a policy for several senses."""
    write(
        name,
        [
            helper.make_node("Concat", [observation, "vestibular"], ["all"], axis=1),
            helper.make_node("Gemm", ["all", "w", "b"], ["sum"]),
            helper.make_node("Tanh", ["sum"], ["action"]),
            helper.make_node("ReduceMean", ["sum"], ["value"], axes=[1]),
        ],
        [value(observation, [batch, angles]), value("vestibular", [batch, BALANCE])],
        [value("value", [batch, 1]), value("action", [batch, actions])],
        [constant("w", weights(angles + BALANCE, actions)), constant("b", bias(actions))],
    )


def eyes():
    """Mean of each colour / 255, of the left eye as bytes with channels first, of the right one as floats with channels last."""
    write(
        "eyes",
        [
            helper.make_node("Cast", ["eye_left"], ["left"], to=FLOAT),
            helper.make_node("ReduceMean", ["left"], ["left_mean"], axes=[2, 3], keepdims=0),
            helper.make_node("ReduceMean", ["eye_right"], ["right_mean"], axes=[1, 2], keepdims=0),
            helper.make_node("Concat", ["left_mean", "right_mean"], ["means"], axis=1),
            helper.make_node("Div", ["means", "scale"], ["actions"]),
        ],
        [value("eye_left", ["batch", 3, SIDE, SIDE], BYTE), value("eye_right", [1, SIDE, SIDE, 3])],
        [value("actions", ["batch", ACTIONS])],
        [constant("scale", np.float32(255))],
    )


def gray():
    """Mean brightness / 255 of the left and the right eye, three times each."""
    write(
        "gray",
        [
            helper.make_node("ReduceMean", ["eye_left_gray"], ["left"], axes=[1, 2], keepdims=0),
            helper.make_node("ReduceMean", ["eye_right_gray"], ["right"], axes=[1, 2], keepdims=0),
            helper.make_node("Concat", ["left", "right"] * (ACTIONS // 2), ["means"], axis=0),
            helper.make_node("Div", ["means", "scale"], ["actions"]),
        ],
        [value("eye_left_gray", [1, SIDE, SIDE]), value("eye_right_gray", [1, SIDE, SIDE])],
        [value("actions", [ACTIONS])],
        [constant("scale", np.float32(255))],
    )


def flat():
    """Some numbers of one vector of all senses: of the left and the right eye, of the angles, of balance."""
    pixels = 3 * SIDE * SIDE
    places = [5, pixels + 7, 2 * pixels, 2 * pixels + ANGLES - 1, 2 * pixels + ANGLES, 2 * pixels + ANGLES + BALANCE - 1]
    write(
        "flat",
        [
            helper.make_node("Gather", ["everything", "places"], ["some"], axis=0),
            helper.make_node("Div", ["some", "scale"], ["output"]),
        ],
        [value("everything", [2 * pixels + ANGLES + BALANCE])],
        [value("output", [ACTIONS])],
        [constant("places", np.array(places, np.int64)), constant("scale", np.float32(255))],
    )


def large():
    """Actions outside every action space: 10 and -10."""
    one = np.where(np.arange(ACTIONS) % 2 == 0, 10, -10).astype(np.float32)
    write(
        "large",
        [
            helper.make_node("ReduceMean", ["vestibular"], ["mean"], axes=[0], keepdims=1),
            helper.make_node("Mul", ["mean", "zero"], ["nothing"]),
            helper.make_node("Add", ["nothing", "one"], ["action"]),
        ],
        [value("vestibular", ["n"])],
        [value("action", [ACTIONS])],
        [constant("zero", np.float32(0)), constant("one", one)],
    )


def not_finite():
    write(
        "not_finite",
        [
            helper.make_node("Slice", ["observation", "first", "last", "axes"], ["some"]),
            helper.make_node("Mul", ["some", "zero"], ["zeros"]),
            helper.make_node("Log", ["zeros"], ["action"]),
        ],
        [value("observation", ["batch", ANGLES])],
        [value("action", ["batch", ACTIONS])],
        [
            constant("zero", np.float32(0)),
            constant("first", np.array([0], np.int64)),
            constant("last", np.array([ACTIONS], np.int64)),
            constant("axes", np.array([1], np.int64)),
        ],
    )


def whole_numbers():
    write(
        "whole_numbers",
        [helper.make_node("ArgMax", ["observation"], ["action"], axis=1)],
        [value("observation", [1, ANGLES])],
        [value("action", [1, 1], LONG)],
    )


def takes_whole_numbers():
    write(
        "takes_whole_numbers",
        [helper.make_node("Cast", ["observation"], ["action"], to=FLOAT)],
        [value("observation", [1, ANGLES], LONG)],
        [value("action", [1, ANGLES])],
    )


OUT.mkdir(parents=True, exist_ok=True)
network("network", "batch")
network("wrong_name", 1, observation="obs")
network("wrong_shape", 1, angles=ANGLES + 1)
network("wrong_action", 1, actions=ACTIONS - 1)
eyes()
gray()
flat()
large()
not_finite()
whole_numbers()
takes_whole_numbers()
print({p.name: p.stat().st_size for p in sorted(OUT.glob("*.onnx"))})
