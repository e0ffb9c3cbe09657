"""Writes conformance/src/mujoco/generated/offsets.rs: where the fields of MuJoCo's structures are, from the headers of a release.

    python mujoco_offsets.py [HEADERS] [OUT]

HEADERS is a folder that holds mujoco/mujoco.h, by default that of scripts/fetch_mujoco.sh. A C compiler (gcc) evaluates
offsetof for the fields that mjxmacro.h lists, and for the ones named below that it does not list.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parents[1]
# Elements that MIMo's scenes have none of, and bookkeeping.
LEFT_OUT = re.compile(r"^n?(flexnode|flex_node|tuple|text_|plugin|bvh|tree|fluid|island|wrap_x)")
KINDS = {"mjtNum": "F64", "int": "I32", "mjtByte": "U8", "float": "F32"}
OPTION = {
    "mjtNum": "timestep impratio tolerance ls_tolerance noslip_tolerance ccd_tolerance gravity",
    "int": "integrator cone jacobian solver iterations ls_iterations noslip_iterations ccd_iterations disableflags enableflags",
}
CONTACT = {
    "mjtNum": "dist pos frame includemargin friction solref solreffriction solimp",
    "int": "dim geom flex elem vert exclude efc_address",
}
STATISTIC = {"mjtNum": "meaninertia meanmass meansize extent center"}

C = r"""
#include <stdio.h>
#include <stddef.h>
#include <mujoco/mujoco.h>
#include <mujoco/mjxmacro.h>
#define ROW(table, type, name, at, nr, nc) printf("%s|%s|%s|%zu|%s|%s\n", table, type, name, (size_t)(at), nr, nc);
int main(void) {
  printf("VERSION|%d\n", mjVERSION_HEADER);
  printf("CONTACT_SIZE|%zu\n", sizeof(mjContact));
  printf("mjNTEXROLE|%d\n", mjNTEXROLE);
  printf("WARNINGS|%d\n", mjNWARNING);
#define X(name) ROW("MODEL_SIZES", "int", #name, offsetof(mjModel, name), "1", "1")
  MJMODEL_INTS
#undef X
#define X(type, name, nr, nc) ROW("MODEL", #type, #name, offsetof(mjModel, name), #nr, #nc)
  MJMODEL_POINTERS
#undef X
#define X(type, name) ROW("DATA_SIZES", #type, #name, offsetof(mjData, name), "1", "1")
  MJDATA_SCALAR
#undef X
#define X(type, name, nr, nc) ROW("DATA_VECTORS", #type, #name, offsetof(mjData, name), #nr, #nc)
  MJDATA_VECTOR
#undef X
#define X(type, name, nr, nc) ROW("DATA", #type, #name, offsetof(mjData, name), #nr, #nc)
  MJDATA_POINTERS
  MJDATA_ARENA_POINTERS_SOLVER
#undef X
NESTED
  ROW("PARTS", "int", "opt", offsetof(mjModel, opt), "1", "1")
  ROW("PARTS", "int", "stat", offsetof(mjModel, stat), "1", "1")
  ROW("PARTS", "int", "contact", offsetof(mjData, contact), "1", "1")
  ROW("PARTS", "int", "solver_niter", offsetof(mjData, solver_niter), "1", "1")
  ROW("PARTS", "int", "energy", offsetof(mjData, energy), "1", "1")
  ROW("PARTS", "int", "warning", offsetof(mjData, warning), "1", "1")
}
"""


def nested():
    lines = []
    for table, struct, fields in (
        ("OPTION", "mjOption", OPTION), ("CONTACT", "mjContact", CONTACT), ("STATISTIC", "mjStatistic", STATISTIC),
    ):
        for kind, names in fields.items():
            for name in names.split():
                count = f"sizeof((({struct}*)0)->{name}) / sizeof({kind})"
                lines.append(
                    f'  printf("{table}|{kind}|{name}|%zu|1|%zu\\n", offsetof({struct}, {name}), {count});'
                )
    return "\n".join(lines)


def constants(headers):
    text = "".join(path.read_text() for path in (headers / "mujoco").glob("*.h"))
    return {name: value for name, value in re.findall(r"#define\s+(mjN\w+)\s+(\d+)", text)}


def rows(headers):
    with tempfile.TemporaryDirectory() as folder:
        source, program = Path(folder) / "offsets.c", Path(folder) / "offsets"
        source.write_text(C.replace("NESTED", nested()))
        subprocess.run(["gcc", "-I", headers, "-o", program, source], check=True)
        output = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    return [line.split("|") for line in output.splitlines()]


def size(text, known):
    """A number of rows or columns: a number, or the name of a size of mjModel or mjData."""
    text = re.sub(r"^MJ_[MD]\((\w+)\)$", r"\1", text)
    text = known.get(text, text)
    if times := re.match(r"^MJ_M\((\w+)\)\*(\d+)$|^(\w+)\*(\d+)$", text):
        name, factor = (group for group in times.groups() if group)
        return f'Size::Times("{name}", {factor})'
    return f"Size::Fixed({text})" if text.isdigit() else f'Size::Named("{text}")'


def main():
    headers = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE.parent / "target/mujoco/3.3.0/mujoco/include"
    out = Path(sys.argv[2]) if len(sys.argv) > 2 else HERE / "src/mujoco/generated/offsets.rs"
    known = constants(headers)
    numbers, tables = {}, {}
    for table, *row in rows(headers):
        if len(row) == 1:
            numbers[table] = known[table] = row[0]
        elif row[0] in KINDS and not LEFT_OUT.match(row[1]):
            tables.setdefault(table, []).append(row)
    with out.open("w") as f:
        f.write("//! Where the fields of MuJoCo's structures are. Written by `scripts/mujoco_offsets.py`; not to be edited.\n\n")
        f.write("use super::layout::{Field, Kind, Size};\n\n")
        f.write("/// Release that the offsets are of, as `mj_version` gives it.\n")
        f.write(f"pub const VERSION: i32 = {numbers['VERSION']};\n")
        f.write("/// Bytes of an `mjContact`.\n")
        f.write(f"pub const CONTACT_SIZE: usize = {numbers['CONTACT_SIZE']};\n")
        f.write("/// Kinds of warnings, of which `mjData.warning` has two `int`s each: what it concerns, and how often it came.\n")
        f.write(f"pub const WARNINGS: usize = {numbers['WARNINGS']};\n")
        for table, fields in tables.items():
            f.write(f"\n#[rustfmt::skip]\npub const {table}: &[Field] = &[\n")
            for kind, name, at, nr, nc in fields:
                f.write(
                    f'    Field {{ name: "{name}", at: {at}, kind: Kind::{KINDS[kind]}, '
                    f"rows: {size(nr, known)}, cols: {size(nc, known)} }},\n"
                )
            f.write("];\n")
    print(f"{out}: {sum(len(t) for t in tables.values())} fields")


if __name__ == "__main__":
    main()
