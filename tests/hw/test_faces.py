"""Faces: found, judged, described, compared and voted over; and stored only with consent."""

from __future__ import annotations

import stat
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_hw.perception.faces.enrolment import Enrolment, one_face
from tangy_hw.perception.faces.face_detector import FaceError, find_faces
from tangy_hw.perception.faces.face_embedding import describe
from tangy_hw.perception.faces.face_store import (
    FOLDER,
    NoConsent,
    consent,
    consented,
    forget_face,
    keep_face,
    kept_faces,
    read_face,
    read_faces,
)
from tangy_hw.perception.faces.face_votes import vote
from tangy_hw.perception.faces.gallery import AHEAD, ENOUGH, FaceMatch, Gallery, decide
from tangy_hw.perception.faces.reader import FaceReading, HaarReader
from tangy_profiles.store import Store
from tangy_sim.rendering.faces import drawn_face

IDS = ("user1", "user2", "a-b", "b", ".", "..", "Zoë/../x")


def rows(seed: int, count: int = 4, columns: int = 12) -> Any:
    """Make features."""
    made = np.random.default_rng(seed).normal(size=(count, columns)).astype(np.float32)
    return made / np.linalg.norm(made, axis=1, keepdims=True)


def among(middle: int, seed: int, count: int = 6, near: float = 0.35) -> Any:
    """Make features of one person, around a mean of their own."""
    rng = np.random.default_rng((middle, seed))
    made = rows(middle, 1, 200) + rng.normal(size=(count, 200)) * near / np.sqrt(200)
    return (made / np.linalg.norm(made, axis=1, keepdims=True)).astype(np.float32)


class TestSeeing:
    @pytest.mark.parametrize("size", [60, 100, 400])
    def test_a_face_is_found_with_its_eyes_at_any_size(self, size: int) -> None:
        grey: Any = cv2.cvtColor(drawn_face(3, 1, size=size), cv2.COLOR_BGR2GRAY)
        (found,) = find_faces(grey)
        assert found.eyes is not None and 0.4 < found.box[2] / size < 0.85
        (ax, ay), (bx, by) = found.eyes
        assert 0.18 < (bx - ax) / size < 0.3 and abs(by - ay) < 0.06 * size
        assert 0.3 < ay / size < 0.55

    def test_a_face_is_found_in_a_large_frame(self) -> None:
        frame = np.full((720, 1280, 3), 120, np.uint8)
        frame[200:400, 700:900] = drawn_face(4, 1)
        (seen,) = HaarReader().read(frame)
        assert seen.problem == "" and 700 < seen.box[0] < 800 and 200 < seen.box[1] < 300

    def test_no_face_is_found_in_an_empty_picture(self) -> None:
        assert HaarReader().read(np.full((300, 300, 3), 128, np.uint8)) == []
        assert one_face([]) == ("no face is seen", None)

    @pytest.mark.parametrize(
        ("drawn", "says"),
        [
            ({"light": 0.08}, "too dark"),
            ({"light": 0.25}, "contrast"),
            ({"blur": 5.0}, "blurred"),
        ],
    )
    def test_a_poor_face_is_refused_with_the_reason(self, drawn: dict[str, Any], says: str) -> None:
        good, bad = drawn_face(3, 1), drawn_face(3, 1, **drawn)
        grey: Any = cv2.cvtColor(good, cv2.COLOR_BGR2GRAY)
        assert HaarReader().read(good)[0].problem == ""
        dim: Any = cv2.cvtColor(bad, cv2.COLOR_BGR2GRAY)
        from tangy_hw.perception.faces.face_embedding import align
        from tangy_hw.perception.faces.quality import judge

        (found,) = find_faces(grey)
        assert found.eyes is not None
        assert says in judge(dim, found.box, align(dim, found.eyes)).problem()

    def test_light_hardly_changes_the_descriptor_of_a_face(self) -> None:
        face = np.random.default_rng(1).integers(60, 200, (104, 80)).astype(np.uint8)
        face = cv2.GaussianBlur(face, (0, 0), 2.0)  # type: ignore[assignment]
        dim = (face * 0.6).astype(np.uint8)
        assert float(describe(face) @ describe(dim)) > 0.95
        assert float(np.linalg.norm(describe(face))) == pytest.approx(1, abs=1e-5)


class TestComparing:
    @given(st.integers(1, 6), st.integers(0, 1000))
    def test_an_enrolled_person_is_recognised_and_a_stranger_is_not(
        self, people: int, seed: int
    ) -> None:
        gallery = Gallery({f"p{n}": among(n, seed) for n in range(people)})
        for n in range(people):
            assert gallery.compare(among(n, seed + 1, 1, near=0.2)[0]).person == f"p{n}"
        stranger = gallery.compare(among(99, seed, 1)[0])
        assert stranger.person is None and stranger.nearest is not None

    def test_no_person_is_chosen_between_two_similar_scores(self) -> None:
        assert decide({"a": 1.0, "b": 1.0 - AHEAD / 2}).person is None
        assert decide({"a": 1.0, "b": 1.0 - 2 * AHEAD}).person == "a"
        assert decide({"a": ENOUGH - 0.01}).person is None
        assert decide({}) == FaceMatch(None, None, 0.0)

    def test_an_empty_gallery_recognises_nobody(self) -> None:
        assert Gallery({}).compare(rows(1)[0]).person is None

    def test_identical_pictures_cause_no_error(self) -> None:
        same = np.repeat(among(1, 1, 1), 3, axis=0)
        gallery = Gallery({"a": same, "b": same})
        assert gallery.compare(same[0]).person is None  # it may be either
        assert Gallery({"a": same}).compare(same[0]).person == "a"

    @given(st.lists(st.sampled_from(["a", "b", None]), max_size=9))
    def test_a_vote_needs_three_in_five(self, cast: list[str | None]) -> None:
        counted = vote(FaceMatch(one, one, 0.5, {"a": 0.5, "b": 0.4}) for one in cast)
        most = max((cast.count(one) for one in ("a", "b")), default=0)
        if counted.person is not None:
            assert counted.votes == most == cast.count(counted.person)
            assert most >= 2 and most >= 0.6 * len(cast)
        else:
            assert most < 2 or most < 0.6 * len(cast)
        assert counted.frames == len(cast)


class _Reader:
    """A reader that returns given faces."""

    kind = "made"

    def __init__(self, *seen: Any) -> None:
        self.seen = list(seen)

    def read(self, picture: Any) -> list[FaceReading]:
        return [FaceReading((0, 0, 90, 90), "", None, self.seen.pop(0))]


class TestEnrolling:
    def test_repeated_pictures_count_once(self) -> None:
        one, two = among(1, 1, 2)
        enrolment = Enrolment(_Reader(one, one, two))
        told = [enrolment.offer(np.zeros(1, np.uint8)) for _ in range(3)]
        assert told[0] == told[2] == "" and "move the head" in told[1]
        assert len(enrolment) == 2

    def test_pictures_of_another_person_are_dropped(self) -> None:
        pictures = [*among(1, 1, 5), among(2, 1, 1)[0], *among(1, 2, 4)]
        enrolment = Enrolment(_Reader(*pictures))
        for _ in pictures:
            enrolment.offer(np.zeros(1, np.uint8))
        assert enrolment.drop_odd() == [5] and len(enrolment) == 9

    def test_the_nearer_of_two_faces_must_be_clear(self) -> None:
        vector = rows(1)[0]
        near, far = (
            FaceReading((0, 0, 100, 100), "", None, vector),
            FaceReading((0, 0, 30, 30), "", None, vector),
        )
        assert one_face([near, far]) == ("", vector)
        assert one_face([near, near])[0] == "more than one face is seen"
        blurred = FaceReading((0, 0, 110, 110), "blurred")
        assert one_face([blurred, near])[1] is vector
        assert one_face([blurred, far]) == ("blurred", None)


class TestKeeping:
    @settings(max_examples=15)
    @given(
        steps=st.lists(
            st.tuples(st.sampled_from(["yes", "no", "keep", "forget"]), st.sampled_from(IDS)),
            max_size=25,
        )
    )
    def test_face_data_is_stored_only_with_standing_consent(
        self, tmp_path_factory: pytest.TempPathFactory, steps: list[tuple[str, str]]
    ) -> None:
        agreed: set[str] = set()
        kept: set[str] = set()
        with Store.open(tmp_path_factory.mktemp("law") / "d") as store:
            for number, (what, person) in enumerate(steps):
                if what == "keep" and person not in agreed:
                    with pytest.raises(NoConsent):
                        keep_face(store, person, "hoglbp1", rows(number))
                elif what == "keep":
                    keep_face(store, person, "hoglbp1", rows(number))
                    kept.add(person)
                elif what == "forget":
                    assert forget_face(store, person) == (person in kept)
                    agreed.discard(person)
                    kept.discard(person)
                else:
                    consent(store, person, what == "yes", "asked")
                    (agreed.add if what == "yes" else agreed.discard)(person)
                    if what == "no":
                        kept.discard(person)
                assert consented(store) == agreed
                assert {person for person, _ in kept_faces(store)} == kept <= agreed
                assert set(read_faces(store, "hoglbp1")) == kept
                files = list((store.folder / FOLDER).glob("*")) if kept else []
                assert len(files) == len(kept)

    def test_stored_features_are_read_back_unchanged(self, store: Store) -> None:
        consent(store, "user1", True, "asked")
        keep_face(store, "user1", "hoglbp1", rows(1))
        assert np.allclose(read_face(store, "user1", "hoglbp1"), rows(1), atol=1e-3)
        assert read_face(store, "user1", "onnx1") is None
        (path,) = (store.folder / FOLDER).iterdir()
        assert stat.S_IMODE(path.stat().st_mode) == 0o600

    def test_a_damaged_file_is_reported_in_one_sentence(self, store: Store) -> None:
        consent(store, "user1", True, "asked")
        keep_face(store, "user1", "hoglbp1", rows(1))
        (path,) = (store.folder / FOLDER).iterdir()
        content = path.read_bytes()

        @given(st.integers(0, len(content) - 1), st.one_of(st.none(), st.integers(0, 255)))
        def law(at: int, byte: int | None) -> None:
            rest = b"" if byte is None else bytes([byte]) + content[at + 1 :]
            path.write_bytes(content[:at] + rest)
            try:
                back = read_face(store, "user1", "hoglbp1")
            except FaceError as error:
                assert path.name in str(error) and "\n" not in str(error)
            else:  # the byte was the same, or in an unused place
                assert np.allclose(back, rows(1), atol=1e-3)

        law()
        path.write_bytes(b"")
        assert forget_face(store, "user1") and not path.exists()

    def test_nothing_is_written_through_a_symbolic_link(self, store: Store, tmp_path: Path) -> None:
        (tmp_path / "elsewhere").mkdir()
        (store.folder / FOLDER).symlink_to(tmp_path / "elsewhere")
        consent(store, "user1", True, "asked")
        with pytest.raises(FaceError, match="symbolic link"):
            keep_face(store, "user1", "hoglbp1", rows(1))
        assert list((tmp_path / "elsewhere").iterdir()) == []

    def test_an_unwritable_folder_is_reported(self, store: Store) -> None:
        consent(store, "user1", True, "asked")
        (store.folder / FOLDER).write_text("a file")
        with pytest.raises(FaceError, match="cannot be written"):
            keep_face(store, "user1", "hoglbp1", rows(1))


def _like(person: np.ndarray[Any, Any], count: int, chance: np.random.Generator) -> list[Any]:
    """Return features of pictures of a person, of length 1."""
    rows = person + 0.03 * chance.normal(size=(count, len(person)))
    return list(rows / np.linalg.norm(rows, axis=1, keepdims=True))


@pytest.mark.parametrize(("people", "several"), [(1, False), (2, True), (3, True)])
def test_pictures_of_several_people_are_noticed(people: int, several: bool) -> None:
    chance = np.random.default_rng(people)
    enrolment = Enrolment(HaarReader())
    for _ in range(people):
        person = chance.normal(size=200)
        enrolment.take(_like(person / np.linalg.norm(person), 4, chance))
    assert enrolment.several() is several
