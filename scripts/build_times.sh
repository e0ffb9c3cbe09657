#!/usr/bin/env bash
# Measures how long Cargo takes to build the command line, beside another commit, and prints a table of Markdown: the first build in an empty
# folder, and builds after a change of a file of the environments, of the engine and of nothing.
#   scripts/build_times.sh COMMIT [ROUNDS]    # 1 round by default; the commits take turns, and medians are printed
# CPU seconds are those of all processes in user mode; on a busy machine they grow, too, so compare only within a table. Both commits are
# checked out and built in target/build-times, which is removed at the end. Needs Rust, and the network for the index of crates.
set -euo pipefail
cd "$(dirname "$0")/.."
if [ $# -lt 1 ]; then sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 2; fi
before=$(git rev-parse --short "$1") now=$(git rev-parse --short HEAD) rounds=${2:-1}
work=$PWD/target/build-times
clean() {
  for commit in "$before" "$now"; do git worktree remove --force "$work/$commit" 2>/dev/null || true; done
  rm -rf "$work"
}
trap clean EXIT
clean
mkdir -p "$work"
for commit in "$before" "$now"; do git worktree add --quiet --detach "$work/$commit" "$commit"; done
(cd "$work/$before" && cargo fetch --locked)
(cd "$work/$now" && cargo fetch --locked)

TIMEFORMAT='%U %R'
build() { # COMMIT WHAT: appends user and wall seconds
  { time (cd "$work/$1" && CARGO_TARGET_DIR=$work/$1/target CARGO_INCREMENTAL=0 cargo build --quiet --release --locked -p babybench-cli) >&2; } 2>"$work/time"
  cat "$work/time" >&2
  echo "$1 $2 $(tail -n 1 "$work/time")" >>"$work/times"
}
for ((round = 0; round < rounds; round++)); do
  for commit in "$before" "$now"; do
    rm -rf "$work/$commit/target"
    build "$commit" first
  done
  for commit in "$before" "$now"; do
    build "$commit" nothing
    touch "$work/$commit/src/env/mod.rs"
    build "$commit" env
    touch "$work/$commit/src/physics/mod.rs"
    build "$commit" physics
  done
done

python3 - "$work/times" "$before" "$now" <<'END'
import statistics
import sys

times, before, now = sys.argv[1:]
found = {}
for line in open(times, encoding="utf-8"):
    commit, what, user, wall = line.split()
    found.setdefault((what, commit), []).append((float(user), float(wall)))
print(f"| `cargo build --release`, s | {before} CPU | {now} CPU | ratio | {before} wall | {now} wall |")
print("|---|--:|--:|--:|--:|--:|")
names = {"first": "everything", "nothing": "no change", "env": "a change of src/env", "physics": "a change of src/physics"}
for what, name in names.items():
    (u0, w0), (u1, w1) = (map(statistics.median, zip(*found[what, commit])) for commit in (before, now))
    print(f"| {name} | {u0:.1f} | {u1:.1f} | {u1 / max(u0, 1e-9):.2f} | {w0:.1f} | {w1:.1f} |")
END
