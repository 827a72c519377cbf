"""Bad input on the command line: status 2, one sentence on stderr, and no lost data."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from shlex import quote
from subprocess import CompletedProcess

import pytest

from tangy_profiles.activity import shipped_activities
from tangy_profiles.store import Store

Tangy = Callable[..., CompletedProcess[str]]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("dance",), "dance"),
        (("--plain",), "`tangy teach --plain` teaches"),
        (("play", "--gmaes", "3"), "--gmaes"),
        (("play", "--games", "0"), "--games"),
        (("play", "--games", "many"), "--games"),
        (("play", "--users", "25"), "from 1 to 24"),
        (("play", "--users", "0"), "from 1 to 24"),
        (("play", "--speed", "nan"), "--speed"),
        (("play", "--seed", "x"), "--seed"),
        (("play", "--activity", "bingoo"), "did you mean 'bingo'?"),
        (("play", "--activity", "{tmp}/none.toml"), "no such file"),
        (("play", "--activity", "{tmp}/broken.toml"), "broken.toml: is not TOML"),
        (("teach", "--activity", "{tmp}/wrong.toml"), "did you mean 'draw'?"),
        (("learn", "--forest", "papr"), "did you mean 'paper'?"),
        (("teach", "--script", "{tmp}/none.txt"), "none.txt: there is no such file"),
        (("teach", "--script", "{tmp}"), "cannot be read"),
        (("teach", "--script", "{tmp}/bytes.txt"), "cannot be read"),
        (("people", "show", "Rosa"), "nobody called 'Rosa'"),
        (("people", "show"), "Missing argument"),
        (("people", "rename", "user1", " "), "must not be empty"),
        (("people", "rename", "user1", "a\x1b[2Jb"), "cannot be shown"),
        (("people", "rename", "user1", "x" * 41), "at most 40"),
        (("live", "--bench", "--camera", "camera=0"), "the bench brings its own"),
        (("live", "--load", "2"), "add --bench"),
        (("live", "--link-delay", "80"), "only the bench's link is bad: add --bench"),
    ],
)
def test_bad_input_is_status_two_and_one_sentence(
    arguments: tuple[str, ...], said: str, tangy: Tangy, taught: Path, tmp_path: Path
) -> None:
    shipped = shipped_activities()["bingo"].read_text(encoding="utf-8")
    (tmp_path / "broken.toml").write_text("name = ", encoding="utf-8")
    (tmp_path / "wrong.toml").write_text(shipped.replace('"draw"', '"drow"'), encoding="utf-8")
    (tmp_path / "bytes.txt").write_bytes(b"\xff\xfe\x00")
    with Store.open(taught, write=False) as store:
        before = [event.uuid for event in store.events()]
    filled = [a.replace("{tmp}", str(tmp_path)) for a in arguments]
    data = () if len(arguments) == 1 else ("--data", taught)
    done = tangy(*filled, *data)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("tangy: ")
    assert done.stderr.endswith("\n")
    assert done.stderr[:-1].isprintable(), "one line, and nothing that acts on a terminal"
    assert said in done.stderr
    with Store.open(taught, write=False) as store:
        assert [event.uuid for event in store.events()] == before, "nothing lost, nothing added"


@pytest.mark.parametrize("verb", ["policy", "play"])
def test_an_unlearnt_policy_cannot_be_shown_or_played(
    verb: str, tangy: Tangy, tmp_path: Path
) -> None:
    done = tangy(verb, "--data", tmp_path / "empty")
    assert (done.returncode, done.stdout) == (2, "")
    there = f"--data {quote(str(tmp_path / 'empty'))}"
    assert f"`tangy teach {there}`), then choose Learn (`tangy learn {there}`)" in done.stderr


def test_learning_without_demonstrations_is_refused(tangy: Tangy, tmp_path: Path) -> None:
    done = tangy("learn", "--data", tmp_path / "empty")
    assert (done.returncode, done.stdout) == (2, "")
    assert "demonstrate a game first" in done.stderr


@pytest.mark.parametrize("verb", ["teach", "learn", "play", "policy"])
def test_a_file_in_place_of_the_data_folder_is_refused(
    verb: str, tangy: Tangy, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("mine", encoding="utf-8")
    for folder in (tmp_path / "file", tmp_path / "file" / "inside"):
        done = tangy(verb, "--data", folder)
        assert (done.returncode, done.stdout) == (2, "")
        assert str(folder) in done.stderr or "not learnt" in done.stderr
        assert done.stderr.count("\n") == 1
    assert (tmp_path / "file").read_text(encoding="utf-8") == "mine"


@pytest.mark.slow
def test_only_a_second_writer_is_refused(tangy: Tangy, taught: Path) -> None:
    with Store.open(taught):
        for verb in (
            ("teach", "--plain"),
            ("learn",),
            ("play",),
            ("people", "rename", "user1", "R"),
        ):
            done = tangy(*verb, "--data", taught)
            assert (done.returncode, done.stdout) == (2, "")
            assert "is writing to" in done.stderr
            assert "--data" in done.stderr
        assert tangy("policy", "--json", "--data", taught).returncode == 0
        assert tangy("people", "list", "--json", "--data", taught).returncode == 0
        assert tangy("doctor", "--data", taught).returncode == 0
    assert tangy("learn", "--data", taught).returncode == 0


def test_the_default_data_folder_is_that_of_the_platform(
    tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    assert tangy("teach", "--plain", stdin="greet everyone\ny\n").returncode == 0
    assert list(tmp_path.rglob("tangy.db"))


@pytest.mark.parametrize(
    ("words", "told"),
    [(("lisen",), "did you mean 'listen'"), (("qqq",), "choose one of: activity,")],
)
def test_an_unknown_command_suggests_the_nearest_one(
    words: tuple[str, ...], told: str, tangy: Tangy
) -> None:
    done = tangy(*words)
    assert (done.returncode, done.stdout) == (2, "")
    assert told in done.stderr
