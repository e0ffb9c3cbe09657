"""Reads logs with only pickle and NumPy, and prints the kit's scores of them as JSON.

Usage: read_logs.py TRAINING.pkl ...           a score for each
       read_logs.py --evaluation EVALUATION.pkl   shape, type and sum of qpos, and the information
The formulas are those of the kit's evaluation of self_touch and hand_regard.
"""

import json
import pickle
import sys

import numpy as np


def chosen(log):
    """The last records that count, newest first."""
    n = min(10_001, len(log))
    return [log[-k] for k in range(1, n)]


def score(log):
    records = chosen(log)
    if "right_hand_touches" in log[0]:
        hands = [set(), set()]
        for record in records:
            for hand, key in zip(hands, ("right_hand_touches", "left_hand_touches")):
                hand.update(record[key])
        return (len(hands[0]) + len(hands[1])) / 68
    keys = [f"{eye}_eye_{hand}_hand" for eye in ("right", "left") for hand in ("right", "left")]
    return sum(record[key] for record in records for key in keys) / (4 * sum(record["steps"] for record in records))


def load(path):
    with open(path, "rb") as file:
        return pickle.load(file)


if sys.argv[1] == "--evaluation":
    log = load(sys.argv[2])
    qpos = log["qpos"]
    assert all(type(q) is np.ndarray and q.dtype == np.float64 and q.flags.writeable for q in qpos)
    array = np.array(qpos)
    assert all(type(info) is dict for info in log["info"])
    print(json.dumps({"shape": array.shape, "qpos": [float(q).hex() for q in array.ravel()], "info": log["info"]}))
else:
    print(json.dumps([score(load(path)) for path in sys.argv[1:]]))
