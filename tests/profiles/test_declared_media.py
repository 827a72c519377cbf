"""Pictures and sounds of an activity: files beside it, each of them checked."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.declared.activity import DeclaredActivity, read_declared
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.media import LONGEST_SOUND
from tangy_profiles.declared.source import MistakesError
from tangy_profiles.declared.speech import media
from tests.support.media import guess_the_sound, make_picture, make_sound


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return guess_the_sound(tmp_path)


def mistakes(file: Path) -> tuple[str, ...]:
    with pytest.raises(MistakesError) as found:
        read_declared(file)
    return found.value.lines


def played(activity: DeclaredActivity) -> DeclaredGame:
    game = DeclaredGame(activity.declaration, ("one",), (0, 2))
    game.execute("play a sound", "one")
    return game


def test_a_column_names_the_picture_and_the_sound_of_each_row(file: Path) -> None:
    game = played(read_declared(file))
    _, sound = media(game, "play a sound")
    assert sound == (str(file.parent / "bell.wav"), 2.0)
    picture, none = media(game, "praise the ear")
    assert (picture is not None and picture.path, none) == (str(file.parent / "bell.png"), None)
    game.execute("play a sound", "one")
    assert media(game, "praise the ear") == (None, None)  # a train has no picture


def test_a_missing_file_is_reported_once_with_its_place_in_both_files(file: Path) -> None:
    (file.parent / "kettle.wav").unlink()
    (line,) = mistakes(file)
    where = 'sound = "{clip}"'
    lines = file.read_text(encoding="utf-8").splitlines()
    place = f"{file.name}:{lines.index(where) + 1}:{where.index('{') + 1}:"
    assert line == (
        f"{place} behaviours.play a sound.sound: row 3, column clip: "
        "there is no file 'kettle.wav' beside this one."
    )


def test_a_file_of_another_kind_is_reported(file: Path) -> None:
    (file.parent / "bell.png").write_bytes(b"<svg/>")
    (file.parent / "dog.wav").write_bytes(b"ID3 is no WAV")
    make_sound(file.parent / "train.wav", LONGEST_SOUND + 1)
    told = " ".join(mistakes(file))
    assert "bell.png is no PNG, JPEG, GIF or WebP picture." in told
    assert "dog.wav is no WAV sound that can be played." in told
    assert "train.wav must last 180 s at most." in told


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("{photos}", "{photos} is not a column of the items; did you mean 'photo'?"),
        ("{points}", "{points} is not a column of the items; did you"),
        ("../bell.png", "../bell.png must be the name of a file beside this one."),
    ],
)
def test_an_invalid_file_name_is_reported(file: Path, text: str, told: str) -> None:
    lines = file.read_text(encoding="utf-8").replace('"{photo}"', f'"{text}"', 1)
    file.write_text(lines, encoding="utf-8")
    assert told in " ".join(mistakes(file))


def test_a_fixed_file_is_used_in_every_round(file: Path) -> None:
    make_picture(file.parent / "ear.png")
    lines = file.read_text(encoding="utf-8").replace('"{photo}"', '"ear.png"')
    file.write_text(lines, encoding="utf-8")
    picture, _ = media(played(read_declared(file)), "praise the ear")
    assert picture is not None and picture.path.endswith("ear.png")


def test_a_sound_with_a_damaged_header_is_refused(file: Path) -> None:
    sound = bytearray((file.parent / "bell.wav").read_bytes())
    sound[18] = 127  # the first chunk reaches beyond the file
    (file.parent / "bell.wav").write_bytes(sound)
    assert "bell.wav is no WAV sound" in " ".join(mistakes(file))


def test_an_overlong_file_name_is_reported(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    file.write_text(
        text.replace('sound = "{clip}"', f'sound = "{"a" * 300}.wav"'), encoding="utf-8"
    )
    assert "there is no file" in " ".join(mistakes(file))
