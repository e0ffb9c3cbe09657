"""Measures Ray with two nodes: actors of ``examples/ray_vectors.py`` on one and on both, and an iteration of RLlib's PPO.

Starts two nodes on this machine (``ray start``), each with a core of its own, and stops them.
Needs ``pip install "ray[rllib]" torch``.
"""

from __future__ import annotations

import argparse
import os
import re
import socket
import subprocess
import sys
import time
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"


def start(*arguments: str) -> subprocess.Popen[bytes]:
    """Starts a node with one core, which ends with its process."""
    ray = [sys.executable, "-m", "ray.scripts.scripts", "start", "--block", "--num-cpus=1"]
    return subprocess.Popen([*ray, "--object-store-memory=200000000", *arguments], stdout=subprocess.DEVNULL)


def listens(port: int) -> bool:
    """Returns whether a port of this machine is open."""
    with socket.socket() as to:
        return to.connect_ex(("127.0.0.1", port)) == 0


def run(name: str, *arguments: str, address: str) -> str:
    """Runs an example on the nodes and returns its last line."""
    # ray.init looks at the variable where a program names no address
    environment = {**os.environ, "RAY_ADDRESS": address}
    command = [sys.executable, str(EXAMPLES / name), *arguments]
    done = subprocess.run(command, check=True, capture_output=True, text=True, env=environment)
    lines = [line for line in done.stdout.splitlines() if " steps, " in line]
    return lines[-1]


def speed(line: str) -> int:
    """Reads steps per second."""
    found = re.search(r"(\d+)/s", line)
    if found is None:
        raise ValueError(f"no speed in {line!r}")
    return int(found.group(1))


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--port", type=int, default=6390, help="of the head node")
    parser.add_argument("--iterations", type=int, default=10, help="of the search; RLlib makes one")
    args = parser.parse_args()
    address = f"127.0.0.1:{args.port}"
    nodes = [start("--head", f"--port={args.port}", "--include-dashboard=false")]
    try:
        while not listens(args.port):
            time.sleep(0.2)
        nodes.append(start(f"--address={address}"))
        print("| what | nodes | environment steps a second, by the clock |")
        print("|---|--:|--:|")
        for workers in (1, 2, 1, 2):
            search = ["--address", address, "--workers", str(workers), "--iterations", str(args.iterations)]
            print(
                f"| `ray_vectors.py` | {workers} | {speed(run('ray_vectors.py', *search, address=address))} |",
                flush=True,
            )
        for more, what in (([], "environments one by one"), (["--vector"], "the library's vector")):
            line = run("rllib_selftouch.py", "--iterations", "1", *more, address=address)
            print(f"| `rllib_selftouch.py`, PPO, {what} | 1 | {speed(line)} |", flush=True)
    finally:
        for node in reversed(nodes):
            node.terminate()
            node.wait()


if __name__ == "__main__":
    main()
