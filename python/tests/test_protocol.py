"""Protocols: their descriptions, a short run, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

import babybench
import babybench.protocol


def test_protocols_are_described_with_sources():
    assert babybench.protocol.names() == ["pull_to_sit", "supported_sit", "kick", "self_touch", "roll_over", "mobile"]
    for name in babybench.protocol.names():
        found = babybench.protocol.describe(name)
        assert found["name"] == name
        assert found["ages"]
        assert all(phase["seconds"] > 0 for phase in found["phases"])
        for row in found["published"]:
            assert row["source"]
            assert row["mark"] in "rsmhu"
    with pytest.raises(KeyError, match="did you mean"):
        babybench.protocol.describe("mobil")


def test_a_short_run_has_ours_beside_published_numbers(tmp_path: Path):
    result = babybench.protocol.run("pull_to_sit", tmp_path / "a", "zero", ages=[0, 6], length=0.1)
    lags = {run["age"]: run["values"]["controller"]["pull"]["at_45"] for run in result["runs"]}
    assert lags[0] > 45
    assert lags[6] < 8
    first = result["comparisons"][0]
    assert first["published"]["value"] == 3.5
    assert first["difference"]["absolute"] == pytest.approx(first["ours"]["mean"] - 3.5)
    assert sorted(path.name for path in (tmp_path / "a").iterdir()) == [
        "figure.svg",
        "manifest.json",
        "protocol.json",
        "protocol.md",
        "runs",
    ]
    strong = babybench.protocol.run(
        "pull_to_sit", tmp_path / "b", "zero", ages=[0], length=0.1, jobs=1, strength="volume", springs="fixed"
    )
    assert strong["runs"][0]["values"]["controller"]["pull"]["at_45"] < 10


def test_what_is_refused(tmp_path: Path):
    for keywords, text in (
        ({"length": 0}, "length is 0"),
        ({"seeds": 0}, "seeds is 0"),
        ({"ages": [30]}, "from 0 to 24"),
        ({"policies": []}, "policies is"),
        ({"strengths": "infant"}, "did you mean `strength`"),
        ({"policy_timeout": -1.0}, "policy_timeout"),
    ):
        with pytest.raises(ValueError, match=text):
            babybench.protocol.run("kick", tmp_path / "never", **keywords)
    assert not (tmp_path / "never").exists()
