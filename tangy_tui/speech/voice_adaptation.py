"""Estimates transforms of the acoustic model's means from sound whose words are known (MLLR).

The sound is aligned with its words. From the posteriors of the Gaussians one affine transform of
each stream of features is estimated for a class of phones (Leggetter and Woodland 1995).
"""

from __future__ import annotations

import struct
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tangy_tui.speech.noise_reduction import cleared
from tangy_tui.speech.other_voices import (
    BASES,
    MODEL,
    NO_SPEECH,
    PHONES,
    SIZE,
    STREAMS,
    base_means,
    of_one_voice,
    read_means,
    voice_text,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Values = NDArray[np.float64]

BEAM = 1e-120
LOG_BASE, SHIFT = 1.0001, 10  # of the stored mixture weights
PRIOR = 200.0  # frames of unmoved speech that each transform begins with
FEWEST = 6  # sentences that have to fit their words
WORTH_IT = 3.0  # gain in log-likelihood per frame from which a voice is kept


class Model(NamedTuple):
    """The acoustic model: phones by place, Gaussians (phones, streams, densities, size), weights.

    The weights are logarithms, shape (streams, densities, states).
    """

    phones: Sequence[str]
    head: bytes
    means: Values
    variances: Values
    weights: Values


class AlignedState(NamedTuple):
    """A state of a phone, and its features (frames, streams, size)."""

    phone: str
    state: int
    features: Values


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

    def align(self, pcm: bytes, text: str) -> Iterator[AlignedState]:
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
                    yield AlignedState(phone.name, int(state.name), here)

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


def count(model: Model, means: Values, found: Iterable[AlignedState]) -> Sums:
    """Sum up the features of aligned states by the posteriors of their Gaussians."""
    sums = Sums(np.zeros(means.shape[:3]), np.zeros(means.shape))
    for phone, state, features in found:
        at = model.phones.index(phone)
        for stream in range(STREAMS):
            logs = _likelihoods(model, means, at, stream, state, features)
            share = np.exp(logs - logs.max(1, keepdims=True))
            share /= share.sum(1, keepdims=True)
            sums.frames[at, stream] += share.sum(0)
            sums.features[at, stream] += share.T @ features[:, stream]
    return sums


def fit(model: Model, means: Values, found: Sequence[AlignedState]) -> float:
    """Return the mean log-likelihood of aligned states per frame."""
    told, frames = 0.0, 1e-9
    for phone, state, features in found:
        at = model.phones.index(phone)
        frames += len(features)
        for stream in range(STREAMS):
            logs = _likelihoods(model, means, at, stream, state, features)
            told += float(np.logaddexp.reduce(logs, axis=1).sum())
    return told / frames


def _likelihoods(
    model: Model, means: Values, phone: int, stream: int, state: int, features: Values
) -> Values:
    """Return log-likelihoods of the Gaussians of a state, shape (frames, densities)."""
    variances = model.variances[phone, stream]
    apart = features[:, stream, None] - means[phone, stream]
    constant = model.weights[stream][:, state] - 0.5 * np.log(variances).sum(-1)
    logs: Values = constant - 0.5 * (apart**2 / variances).sum(-1)
    return logs


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


class KnownSound(NamedTuple):
    """An utterance (16 kHz mono s16le), and its words."""

    pcm: bytes
    text: str


def voice_of(said: Sequence[KnownSound], words: str) -> str:
    """Return the voice of a person who read these sentences (see `other_voices.means_of`).

    Of the usual means and those of other voices, the better ones are moved by one transform.

    Args:
        said: the sentences.
        words: the dictionary of their words.

    Returns:
        the voice; "" if it fits hardly better than the usual means, or few sentences fit their
        words.
    """
    model = read_model()
    speech = [one for place, one in enumerate(model.phones) if place not in NO_SPEECH]
    starts = {base: base_means(base) for base in BASES}
    found: dict[str, list[AlignedState]] = {}
    with tempfile.TemporaryDirectory(prefix="tangy-speech-") as name:
        folder = Path(name)
        (folder / "dict").write_text(words, encoding="utf-8")
        (folder / "logs").mkdir()
        for base, means in starts.items():
            (folder / "means").write_bytes(model.head + means.astype("<f4").tobytes())
            aligner = Aligner(folder / "dict", folder / "logs", folder / "means")
            each = [list(aligner.align(cleared(one.pcm), one.text)) for one in said]
            if sum(map(bool, each)) >= FEWEST:
                found[base] = [one for states in each for one in states if one.phone in speech]
    if not found:
        return ""
    fits = {base: fit(model, starts[base], states) for base, states in found.items()}
    base = max(fits, key=lambda one: fits[one])
    sums = count(model, starts[base], found[base])
    begun = model._replace(means=starts[base])
    transform = estimate(begun, sums, unmoved(), [" ".join(speech)])[-1]
    moved = of_one_voice(starts[base], transform)
    gained = fit(model, moved, found[base]) - fit(model, starts["usual"], found[base])
    return voice_text(base, transform) if gained >= WORTH_IT else ""
