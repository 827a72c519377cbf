"""Estimate the transforms of the acoustic model for other voices (`speech/other_voices.py`).

Run by hand: `python -m tests.bench.voice_transforms` (needs espeak-ng) writes them where Tangy
reads them. Voices of espeak that no bench uses say sentences that hold no stop command. The sound
is aligned with the known words. From the posteriors of the Gaussians each phone's transform is
estimated (MLLR), first one for each class of phones, then, aligned again, one for each phone.
"""

from __future__ import annotations

import struct
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tangy_tui.language.words import spoken, words_of
from tangy_tui.speech import other_voices
from tangy_tui.speech.noise_reduction import cleared
from tangy_tui.speech.other_voices import MODEL, PHONES, SIZE, STREAMS, TRANSFORMS, read_means
from tests.bench.sentences import FAR, NEAR, WORDINGS
from tests.bench.spoken_stops import Said, Voices

Values = NDArray[np.float64]

VOICES = (
    *("en-us", "en-gb+m2", "en-us+m4 -p 40", "en-gb+f5 -s 155", "en-gb-x-gbclan+m6", "en-us+f4"),
    *("en-gb-x-gbcwmd+f2 -s 150", "en-029+m5"),
)
EACH = 45  # sentences of each voice
CLASSES = (
    "AA AE AH AO AW AY EH ER EY IH IY OW OY UH UW",
    "M N NG",
    "L R W Y",
    "P T K B D G",
    "S SH Z ZH F TH V DH HH CH JH",
)
PRIOR = 200.0  # frames of unmoved speech that each transform begins with
MAP_FRAMES = 20.0  # of each Gaussian's own mean, to align a second time
BEAM = 1e-120
LOG_BASE, SHIFT = 1.0001, 10  # of the stored mixture weights
SILENT = "SIL"


class Model(NamedTuple):
    """The acoustic model: phones by place, Gaussians (phones, streams, densities, size), weights.

    The weights are logarithms, shape (streams, densities, states).
    """

    phones: Sequence[str]
    head: bytes
    means: Values
    variances: Values
    weights: Values


class Sums(NamedTuple):
    """Occupancies of Gaussians (phones, streams, densities), and sums of features."""

    frames: Values
    features: Values


def read_model() -> Model:
    """Read pocketsphinx's model."""
    import pocketsphinx

    folder = Path(pocketsphinx.get_model_path(MODEL)).parent
    head, means = read_means((folder / "means").read_bytes())
    _, variances = read_means((folder / "variances").read_bytes())
    weights = (folder / "sendump").read_bytes()
    place = 0
    while (length := struct.unpack_from("<i", weights, place)[0]) != 0:
        place += 4 + length
    densities, states = struct.unpack_from("<2i", weights, place + 4)
    stored = np.frombuffer(weights, np.uint8, STREAMS * densities * states, place + 12)
    logs = -(stored.astype(np.float64) * 2**SHIFT) * np.log(LOG_BASE)
    return Model(
        _phones((folder / "mdef").read_bytes()),
        head,
        means,
        np.maximum(variances, 1e-4),
        logs.reshape(STREAMS, densities, states),
    )


def _phones(definition: bytes) -> list[str]:
    place = 12 + struct.unpack_from("<i", definition, 8)[0] + 40  # description and counts
    return [name.decode() for name in definition[place:].split(b"\0", PHONES)[:PHONES]]


class Aligner:
    """Aligns sound with known words."""

    def __init__(self, dictionary: Path, logs: Path, means: Path | None = None) -> None:
        import pocketsphinx

        moved = {} if means is None else {"mean": str(means)}
        self._logs = logs
        self._decoder: Any = pocketsphinx.Decoder(
            lm=None, dict=str(dictionary), cmn="batch", loglevel="FATAL", bestpath=False,
            beam=BEAM, wbeam=BEAM, pbeam=BEAM, mfclogdir=str(logs), **moved,
        )  # fmt: skip

    def align(self, pcm: bytes, text: str) -> Iterator[tuple[str, int, Values]]:
        """Yield phone, state, and its features (frames, streams, size); none if it fails."""
        decoder = self._decoder
        for old in self._logs.iterdir():
            old.unlink()
        try:
            decoder.set_align_text(text)
            self._decode(pcm)
            if decoder.hyp() is None:
                return
            (log,) = self._logs.iterdir()
            content = log.read_bytes()
            decoder.set_alignment()
            self._decode(pcm)  # a search for the states, which has no hypothesis
        except (RuntimeError, ValueError):
            return
        order = ">" if struct.unpack(">i", content[:4])[0] * 4 + 4 == len(content) else "<"
        features = _features(np.frombuffer(content[4:], f"{order}f4").reshape(-1, SIZE))
        for word in decoder.get_alignment() or ():
            for phone in word:
                for state in phone:
                    here = features[state.start : state.start + state.duration]
                    yield phone.name, int(state.name), here

    def _decode(self, pcm: bytes) -> None:
        self._decoder.reinit_feat()
        self._decoder.start_utt()
        self._decoder.process_raw(pcm, full_utt=True)
        self._decoder.end_utt()


def _features(cepstra: NDArray[Any]) -> Values:
    """Return the three streams: cepstra without their mean, and two differences."""
    plain = cepstra.astype(np.float64) - cepstra.mean(0)
    around = np.pad(plain, ((3, 3), (0, 0)), "edge")
    at = np.arange(len(plain)) + 3
    first = around[at + 2] - around[at - 2]
    second = (around[at + 3] - around[at - 1]) - (around[at + 1] - around[at - 3])
    return np.stack([plain, first, second], 1)


def count(model: Model, means: Values, found: Iterator[tuple[str, int, Values]]) -> Sums:
    """Sum up the features of aligned states by the posteriors of their Gaussians."""
    sums = Sums(np.zeros(means.shape[:3]), np.zeros(means.shape))
    scale = -0.5 * np.log(model.variances).sum(-1)
    for phone, state, features in found:
        at = model.phones.index(phone)
        for stream in range(STREAMS):
            apart = features[:, stream, None] - means[at, stream]
            logs = scale[at, stream] + model.weights[stream][:, state]
            logs = logs - 0.5 * (apart**2 / model.variances[at, stream]).sum(-1)
            share = np.exp(logs - logs.max(1, keepdims=True))
            share /= share.sum(1, keepdims=True)
            sums.frames[at, stream] += share.sum(0)
            sums.features[at, stream] += share.T @ features[:, stream]
    return sums


def estimate(model: Model, sums: Sums, start: Values, classes: Sequence[str]) -> Values:
    """Return transforms (phones, streams, size, 1 + size), constant first.

    Args:
        model: the acoustic model.
        sums: what was counted.
        start: transforms of the same shape, which they are drawn to.
        classes: the phones that share a transform, in one text each.
    """
    made = start.copy()
    for names in classes:
        at = [model.phones.index(name) for name in names.split()]
        for stream in range(STREAMS):
            means = model.means[at, stream].reshape(-1, SIZE)
            points = np.hstack([np.ones((len(means), 1)), means])
            frames = sums.frames[at, stream].reshape(-1, 1)
            features = sums.features[at, stream].reshape(-1, SIZE)
            variances = model.variances[at, stream].reshape(-1, SIZE)
            prior = PRIOR / len(means)
            for row in range(SIZE):
                precise = 1 / variances[:, row, None]
                before = (points * prior * precise).T @ points + 1e-6 * np.eye(1 + SIZE)
                seen = (points * frames * precise).T @ points
                told = (points * features[:, row, None] * precise).sum(0)
                drawn = before @ start[at[0], stream, row]
                made[at, stream, row] = np.linalg.solve(seen + before, told + drawn)
    return made


def unmoved() -> Values:
    """Return transforms that change nothing."""
    made = np.zeros((PHONES, STREAMS, SIZE, 1 + SIZE))
    made[..., 1:] = np.eye(SIZE)
    return made


def texts() -> list[str]:
    """Return what the voices say."""
    return list(dict.fromkeys((*FAR, *NEAR, *WORDINGS)))


def main() -> None:
    """Write the transforms."""
    import pocketsphinx

    model = read_model()
    dictionary = Path(pocketsphinx.get_model_path("en-us/cmudict-en-us.dict"))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for part in ("sound", "logs"):
            (folder / part).mkdir()
        voices = Voices(folder / "sound")
        chosen = texts()
        said = [
            Said("talk", text, voice)
            for place, voice in enumerate(VOICES)
            for text in chosen[place % 4 :: 4][:EACH]
        ]
        voices.say(said)

        def counted(aligner: Aligner, means: Values) -> Sums:
            def found() -> Iterator[tuple[str, int, Values]]:
                for one in said:
                    heard = cleared(voices.heard(one, "clean", ()))
                    yield from aligner.align(heard, spoken(words_of(one.text)))

            return count(model, means, found())

        sums = counted(Aligner(dictionary, folder / "logs"), model.means)
        coarse = estimate(model, sums, unmoved(), CLASSES)
        moved = other_voices.transformed(model.means, coarse)
        mapped = (MAP_FRAMES * moved + sums.features) / (MAP_FRAMES + sums.frames[..., None])
        (folder / "means").write_bytes(model.head + mapped.astype("<f4").tobytes())
        again = counted(Aligner(dictionary, folder / "logs", folder / "means"), mapped)
        speech = [name for name in model.phones if name != SILENT and name.isalpha()]
        fine = estimate(model, again, coarse, speech)
    path = Path(other_voices.__file__).with_name(TRANSFORMS)
    path.write_bytes(fine.astype("<f2").tobytes())


if __name__ == "__main__":
    main()
