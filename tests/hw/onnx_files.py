"""Small ONNX files made by hand, in place of models that may not be shipped here.

`recogniser_file` takes a face of 112 x 112 pixels, as SFace does, and returns the mean colours of
its 49 squares: poor at faces, but a model that OpenCV loads and runs. `finder_file` has the
inputs and outputs of YuNet, and finds a face at every bright green spot.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence


def recogniser_file() -> bytes:
    """Return a model with the interface of SFace."""
    nodes = [
        _node("AveragePool", ["data"], ["pooled"], kernel_shape=[16, 16], strides=[16, 16]),
        _node("Flatten", ["pooled"], ["fc1"]),
    ]
    return _model(nodes, [], _value("data", [1, 3, 112, 112]), [_value("fc1", [1, 147])])


def finder_file() -> bytes:
    """Return a model with the interface of YuNet: four heads at strides of 8, 16 and 32 pixels."""
    nodes, weights, outputs = [], [], []
    points = [-0.6, -0.3, 1.6, -0.3, 0.5, 0.6, -0.3, 1.5, 1.3, 1.5]  # of eyes, nose and mouth
    for stride in (8, 16, 32):
        # Of green, less blue and red; only the middle stride answers.
        seen = [w for c in (-1.0, 2.0, -1.0) for w in [c / (255 * stride**2)] * stride**2]
        sure = -4.0 if stride == 16 else -60.0
        heads = {
            "cls": (1, [value * 10 for value in seen], [sure]),
            "obj": (1, [0.0] * len(seen), [20.0]),
            "bbox": (4, [0.0] * 4 * len(seen), [0.5, 0.5, 1.6, 1.6]),
            "kps": (10, [0.0] * 10 * len(seen), points),
        }  # fmt: skip
        for head, (channels, values, bias) in heads.items():
            name = f"{head}_{stride}"
            weights += [
                _tensor(f"{name}_w", [channels, 3, stride, stride], values),
                _tensor(f"{name}_b", [channels], bias),
                _tensor(f"{name}_s", [1, -1, channels], None),
            ]
            sized = [stride, stride]
            nodes.append(
                _node("Conv", ["input", f"{name}_w", f"{name}_b"], [f"{name}_c"],
                      kernel_shape=sized, strides=sized)
            )  # fmt: skip
            last = f"{name}_c"
            if head in ("cls", "obj"):
                nodes.append(_node("Sigmoid", [last], [f"{name}_g"]))
                last = f"{name}_g"
            nodes.append(_node("Transpose", [last], [f"{name}_t"], perm=[0, 2, 3, 1]))
            nodes.append(_node("Reshape", [f"{name}_t", f"{name}_s"], [name]))
            outputs.append(_value(name, [1, (640 // stride) ** 2, channels]))
    return _model(nodes, weights, _value("input", [1, 3, 640, 640]), outputs)


def _varint(number: int) -> bytes:
    number &= (1 << 64) - 1
    out = bytearray()
    while number > 127:
        out.append(number & 127 | 128)
        number >>= 7
    return bytes([*out, number])


def _number(field: int, value: int) -> bytes:
    return _varint(field << 3) + _varint(value)


def _bytes(field: int, value: bytes | str) -> bytes:
    raw = value.encode() if isinstance(value, str) else value
    return _varint(field << 3 | 2) + _varint(len(raw)) + raw


def _node(kind: str, inputs: Sequence[str], outputs: Sequence[str], **ints: list[int]) -> bytes:
    parts = [_bytes(1, name) for name in inputs] + [_bytes(2, name) for name in outputs]
    parts += [_bytes(3, f"{outputs[0]}_node"), _bytes(4, kind)]
    for name, values in ints.items():
        attribute = _bytes(1, name) + b"".join(_number(8, value) for value in values)
        parts.append(_bytes(5, attribute + _number(20, 7)))
    return _bytes(1, b"".join(parts))


def _tensor(name: str, sizes: Sequence[int], values: Sequence[float] | None) -> bytes:
    """Make an initialiser of floats; without values one of integers: the sizes."""
    if values is None:
        raw, kind, dims = struct.pack(f"<{len(sizes)}q", *sizes), 7, [len(sizes)]
    else:
        raw, kind, dims = struct.pack(f"<{len(values)}f", *values), 1, list(sizes)
    parts = [_number(1, size) for size in dims] + [
        _number(2, kind),
        _bytes(8, name),
        _bytes(9, raw),
    ]
    return _bytes(5, b"".join(parts))


def _value(name: str, sizes: Sequence[int]) -> bytes:
    shape = b"".join(_bytes(1, _number(1, size)) for size in sizes)
    return _bytes(1, name) + _bytes(2, _bytes(1, _number(1, 1) + _bytes(2, shape)))


def _model(
    nodes: Sequence[bytes], weights: Sequence[bytes], taken: bytes, given: Sequence[bytes]
) -> bytes:
    graph = b"".join([*nodes, _bytes(2, "made"), *weights, _bytes(11, taken)])
    graph += b"".join(_bytes(12, value) for value in given)
    return _number(1, 7) + _bytes(8, _bytes(1, "") + _number(2, 11)) + _bytes(7, graph)
