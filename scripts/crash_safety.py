#!/usr/bin/env python3
"""Kills training, evaluation and report at random moments, fills their disk, takes away their folder and sets their clock back, and
checks that every log can be read afterwards, that no finished episode is lost and that nothing is left over. Prints a table of Markdown.

    scripts/crash_safety.py [PROGRAM [KILLS]]    # target/release/babybench, 300

Needs Linux, unshare and mount (util-linux) for the disks, faketime (Debian's package) for the clock. The result is in docs/crash-safety.md.
"""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "target/release/babybench")
KILLS = int(sys.argv[2]) if len(sys.argv) > 2 else 300
SIGNALS = [signal.SIGKILL, signal.SIGINT, signal.SIGTERM, signal.SIGHUP]
CONFIG = """behavior: self_touch
scene: base
touch_active: false
vision_active: false
save_dir: run
max_episode_steps: 5
save_logs_every: 1
render_size: 64
"""
COMMANDS = {
    "train": ["train", "--config", "c.yml", "--train-for", "1000000000", "--resume", "--quiet"],
    "train --envs 4": ["train", "--config", "c.yml", "--train-for", "1000000000", "--resume", "--quiet", "--envs", "4"],
    "evaluate": ["evaluate", "--config", "c.yml", "--episodes", "1000000", "--duration", "5", "--quiet"],
    "report": ["report", "run"],
}
# Seconds until the signal, at most: a report is soon written.
LONGEST = {"train": 1.2, "train --envs 4": 1.2, "evaluate": 2.5, "report": 0.15}


class Fault(Exception):
    pass


def run(folder, arguments, **more):
    return subprocess.run([PROGRAM, *arguments], cwd=folder, capture_output=True, text=True, **more)


def episodes(folder):
    """Checks that all logs can be read; returns the number of episodes of training and of evaluation."""
    logs = os.path.join(folder, "run", "logs")
    found = [name for name in os.listdir(logs)] if os.path.isdir(logs) else []
    trained = 0
    if "training.pkl" in found:
        score = run(folder, ["score", "run", "--json"])
        if score.returncode and "train for at least two episodes" not in score.stderr:
            raise Fault(f"score: {score.stderr.strip()}")
    for name in found:
        if name.endswith(".jsonl") and not name.startswith("."):
            lines = open(os.path.join(logs, name)).read().splitlines()
            for line in lines:
                json.loads(line)
            if name == "training.jsonl":
                trained = len(lines)
    evaluated = sum(name.startswith("evaluation_") and name.endswith(".pkl") for name in found)
    if evaluated:
        report = run(folder, ["report", "run", "--out", "page.html"])
        if report.returncode or "cannot be read" in report.stderr:
            raise Fault(f"report: {report.stderr.strip()}")
    return trained, evaluated


def leftovers(folder):
    """Lists files that a finished run does not leave."""
    walk = os.walk(os.path.join(folder, "run"))
    return [name for _, _, names in walk for name in names if name.endswith(".tmp") or "lock" in name]


def kill(folder, arguments, which, wait):
    """Starts the program and sends it a signal; returns how it ended."""
    program = subprocess.Popen(
        [PROGRAM, *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, restore_signals=True,
        preexec_fn=lambda: [signal.signal(s, signal.SIG_DFL) for s in SIGNALS if s != signal.SIGKILL],
    )
    time.sleep(wait)
    program.send_signal(which)
    try:
        said = program.communicate(timeout=60)[0].decode(errors="replace")
    except subprocess.TimeoutExpired:
        program.kill()
        raise Fault(f"{arguments[0]} continues after {which.name}") from None
    if "panicked" in said:
        raise Fault(said.strip())
    return program.returncode


def start(folder):
    """Makes a folder with a short training in it."""
    with open(os.path.join(folder, "c.yml"), "w") as file:
        file.write(CONFIG)
    first = run(folder, ["train", "--config", "c.yml", "--train-for", "20", "--quiet"])
    if first.returncode:
        raise Fault(first.stderr)


def kills(command, which, count):
    """Kills a command this many times in one folder. Returns the entry of the table."""
    with tempfile.TemporaryDirectory() as folder:
        start(folder)
        before = episodes(folder)
        for _ in range(count):
            kill(folder, COMMANDS[command], which, random.uniform(0.0, LONGEST[command]))
            after = episodes(folder)
            if after[0] < before[0] or after[1] < before[1]:
                raise Fault(f"{before} episodes of training and evaluation before, {after} after")
            before = after
        finish(folder)
        return f"{count} kills; {before[0]} episodes of training and {before[1]} of evaluation at the end"


def finish(folder):
    """An undisturbed run continues from there, and cleans up."""
    trained, _ = episodes(folder)
    last = run(folder, ["train", "--config", "c.yml", "--train-for", str(5 * trained + 20), "--resume", "--quiet"])
    if last.returncode:
        raise Fault(f"train: {last.stderr.strip()}")
    evaluation = run(folder, ["evaluate", "--config", "c.yml", "--episodes", "2", "--duration", "3", "--quiet"])
    if evaluation.returncode:
        raise Fault(f"evaluate: {evaluation.stderr.strip()}")
    run(folder, ["report", "run"])
    left = leftovers(folder)
    if left:
        raise Fault(f"left over: {', '.join(left)}")


def in_namespace(folder, script):
    """Runs a script in its own mount namespace."""
    command = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", script]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=600)


def full_disk():
    """Fills the disk of a training and of an evaluation: each must say so, and the logs before must be whole."""
    with tempfile.TemporaryDirectory() as folder:
        start(folder)
        shutil.copytree(os.path.join(folder, "run"), os.path.join(folder, "before"))
        script = f"""
            mount -t tmpfs -o size=8m none run && cp -r before/. run/ || exit 90
            dd if=/dev/zero of=run/ballast bs=1k count=100000 2>/dev/null
            truncate -s -16k run/ballast
            {PROGRAM} train --config c.yml --train-for 1000000 --resume --quiet; echo "code $?"
            {PROGRAM} evaluate --config c.yml --episodes 500 --duration 5 --quiet; echo "code $?"
            {PROGRAM} report run; echo "code $?"
            {PROGRAM} score run --json > score || echo unreadable
            rm run/ballast; rm -rf before; cp -r run after
        """
        out = in_namespace(folder, script)
        said = out.stdout + out.stderr
        if out.returncode == 90:
            return "not run: no mounts here"
        if said.count("disk is full") < 2 or "unreadable" in said or "panicked" in said:
            raise Fault(said.strip())
        shutil.rmtree(os.path.join(folder, "run"))
        os.rename(os.path.join(folder, "after"), os.path.join(folder, "run"))
        trained, _ = episodes(folder)
        finish(folder)
        return f"said so; {trained} episodes of training are whole"


def read_only():
    """Removes the permission to write: each command must report it, and nothing must change."""
    with tempfile.TemporaryDirectory() as folder:
        start(folder)
        commands = " ; ".join(f'{PROGRAM} {" ".join(c)}; echo "code $?"' for c in COMMANDS.values())
        script = f"mount --bind run run && mount -o remount,ro,bind run || exit 90; {commands}; {PROGRAM} score run"
        before = episodes(folder)
        out = in_namespace(folder, script)
        said = out.stdout + out.stderr
        if out.returncode == 90:
            return "not run: no mounts here"
        if out.returncode or said.count("Read-only file system") < len(COMMANDS) or "panicked" in said:
            raise Fault(said.strip())
        if episodes(folder) != before or leftovers(folder):
            raise Fault("something changed")
        return "said so; nothing changed"


def clock_back():
    """Sets the clock back between runs, and while one runs."""
    if shutil.which("faketime") is None:
        return "not run: there is no faketime"
    with tempfile.TemporaryDirectory() as folder:
        start(folder)
        before = episodes(folder)[0]
        for when in ["-1d", "1980-01-01 00:00:00", "@2000-01-01 00:00:00 x-5"]:
            arguments = ["train", "--config", "c.yml", "--train-for", str(5 * before + 50), "--resume", "--quiet"]
            out = subprocess.run(["faketime", "-f", when, PROGRAM, *arguments], cwd=folder, capture_output=True, text=True, timeout=120)
            after = episodes(folder)[0]
            if out.returncode or after <= before:
                raise Fault(f"{when}: {out.stderr.strip()}, {before} and {after} episodes")
            before = after
        finish(folder)
        return f"{before} episodes at the end"


def main():
    random.seed(1)
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True, text=True).stdout.strip()
    print(f"Commit {commit}.\n\n| what | how | result |\n|---|---|---|", flush=True)
    cases = [(c, s) for c in COMMANDS for s in SIGNALS]
    each, failed = max(1, -(-KILLS // len(cases))), False
    table = [(c, s.name, lambda c=c, s=s: kills(c, s, each)) for c, s in cases]
    table += [("all", "full disk", full_disk), ("all", "read-only folder", read_only), ("train", "clock set back", clock_back)]
    for what, how, test in table:
        try:
            result = test()
        except Fault as fault:
            result, failed = f"FAILED: {fault}", True
        print(f"| {what} | {how} | {result} |", flush=True)
    sys.exit(failed)


if __name__ == "__main__":
    main()
