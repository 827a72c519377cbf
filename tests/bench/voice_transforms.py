"""Estimate the transforms of the acoustic model for other voices (`speech/other_voices.py`).

Run by hand: `python -m tests.bench.voice_transforms` (needs espeak-ng) writes them where Tangy
reads them. Voices of espeak that no bench uses say sentences that hold no stop command. The sound
is aligned with the known words. From the posteriors of the Gaussians each phone's transform is
estimated (MLLR), first one for each class of phones, then, aligned again, one for each phone.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tangy_tui.language.words import spoken, words_of
from tangy_tui.speech import other_voices
from tangy_tui.speech.noise_reduction import cleared
from tangy_tui.speech.other_voices import NO_SPEECH, TRANSFORMS
from tangy_tui.speech.voice_adaptation import (
    AlignedState,
    Aligner,
    Sums,
    count,
    estimate,
    read_model,
    unmoved,
)
from tests.bench.sentences import FAR, NEAR, WORDINGS
from tests.bench.spoken_stops import Said, Voices

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
MAP_FRAMES = 20.0  # of each Gaussian's own mean, to align a second time


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

        def counted(aligner: Aligner, means: NDArray[np.float64]) -> Sums:
            def found() -> Iterator[AlignedState]:
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
        speech = [one for place, one in enumerate(model.phones) if place not in NO_SPEECH]
        fine = estimate(model, again, coarse, speech)
    path = Path(other_voices.__file__).with_name(TRANSFORMS)
    path.write_bytes(fine.astype("<f2").tobytes())


if __name__ == "__main__":
    main()
