"""Reads logs of laser scans in CARMEN's format.

Each line is a message. Used are `FLASER` (front laser, 180 degrees: readings, laser pose, odometry
pose), `ROBOTLASER1` (its newer form, with angles) and `ODOM` (odometry alone). In a log corrected
by a mapping program, the laser pose is the corrected one.
"""

from __future__ import annotations

import gzip
import io
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import pi
from pathlib import Path

import numpy as np

from tangy_hw.device_protocols import Pose, Scan
from tangy_profiles.errors import TangyError
from tangy_profiles.given_file import open_given
from tangy_profiles.reading import plain

FARTHEST = 80.0  # metres; FLASER has no maximum range, and SICK scanners report 81.91 for no return
LARGEST_FILE, LARGEST = 200_000_000, 500_000_000  # bytes, packed and unpacked
LONGEST_LINE = 1_000_000  # characters
MOST_SCANS = 200_000  # five and a half hours at ten a second
MOST_READINGS = 40_000_000  # of all scans: 320 MB
BEAMS = 10_000  # no scanner has more


class LogError(TangyError):
    """An unusable log; one sentence with file and line."""


@dataclass(frozen=True, eq=False)
class LoggedScan:
    """A scan of a log.

    `pose` is the logged pose of the laser, `odometry` the odometry pose of the same line, and
    `wheels` that of the last ODOM line before it, if any; `stamp` is in s.
    """

    scan: Scan
    pose: Pose
    odometry: Pose
    wheels: Pose | None
    stamp: float


def read_log(path: Path) -> list[LoggedScan]:
    """Read all scans of a log, plain or gzipped.

    Raises:
        LogError: the log cannot be read, a line is invalid, or it has no scans.
    """
    name = plain(str(path))
    found: list[LoggedScan] = []
    wheels: Pose | None = None
    number = readings = 0
    try:
        for line in _lines(path):
            number += 1
            words = line.split()
            if not words:
                continue
            if words[0] == "ODOM":
                wheels = Pose(*_numbers(words[1:4], 3))
            elif words[0] == "FLASER":
                found.append(_flaser(words, wheels))
            elif words[0] == "ROBOTLASER1":
                found.append(_robot_laser(words, wheels))
            else:
                continue
            if words[0] != "ODOM":
                readings += len(found[-1].scan.ranges)
            if len(found) > MOST_SCANS or readings > MOST_READINGS:
                raise ValueError("there are more scans than a map needs; cut the log into pieces.")
    except OSError as error:
        why = error.strerror or "it is damaged"
        raise LogError(f"{name}: cannot be read ({why}).") from None
    except EOFError:
        raise LogError(f"{name}: breaks off.") from None
    except UnicodeDecodeError:
        raise LogError(f"{name}: is not text, so it is not a log of scans.") from None
    except ValueError as error:
        raise LogError(plain(f"{name}, line {number}: {error}")) from None
    if not found:
        raise LogError(f"{name}: has no scans (lines that begin with FLASER or ROBOTLASER1).")
    return found


def _lines(path: Path) -> Iterator[str]:
    size = 0
    with open_given(path, LARGEST_FILE, LogError) as file:
        packed = file.read(2) == b"\x1f\x8b"
        file.seek(0)
        unpacked = gzip.GzipFile(fileobj=file) if packed else file
        with io.TextIOWrapper(unpacked, encoding="utf-8") as log:
            while line := log.readline(LONGEST_LINE):
                size += len(line)
                if size > LARGEST:
                    raise ValueError(f"the log has more than {LARGEST // 1_000_000} MB.")
                if len(line) == LONGEST_LINE:
                    raise ValueError("the line has no end.")
                yield line


def _numbers(words: Sequence[str], count: int) -> list[float]:
    if len(words) < count:
        raise ValueError("the line ends too early.")
    numbers = []
    for word in words[:count]:
        try:
            numbers.append(float(word))
        except ValueError:
            raise ValueError(f"{word[:20]!r} is not a number.") from None
        if not math.isfinite(numbers[-1]):
            raise ValueError(f"{word[:20]!r} is not a number that can be used.")
    return numbers


def _count(word: str) -> int:
    if not word.isdigit() or not 1 < int(word) <= BEAMS:
        raise ValueError(f"{word[:20]!r} is not a number of readings.")
    return int(word)


def _ranges(
    numbers: Sequence[float], farthest: float
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    ranges = np.array(numbers)
    ranges[(ranges >= farthest) | (ranges <= 0)] = np.inf
    return ranges


def _flaser(words: Sequence[str], wheels: Pose | None) -> LoggedScan:
    count = _count(words[1] if len(words) > 1 else "")
    numbers = _numbers(words[2:], count + 7)
    # 181 and 361 readings cover -90 to +90 degrees; 180 and 360 end one step before
    step = pi / (count - 1 if count % 2 else count)
    scan = Scan(-pi / 2, step, _ranges(numbers[:count], FARTHEST), FARTHEST)
    pose, odometry = Pose(*numbers[count : count + 3]), Pose(*numbers[count + 3 : count + 6])
    return LoggedScan(scan, pose, odometry, wheels, numbers[count + 6])


def _robot_laser(words: Sequence[str], wheels: Pose | None) -> LoggedScan:
    _, first, angle, step, farthest, *_ = _numbers(words[1:], 7)
    count = _count(words[8] if len(words) > 8 else "")
    if step <= 0 or farthest <= 0 or angle <= 0:
        raise ValueError("the scanner's angles or its range are not above 0.")
    ranges = _numbers(words[9:], count)
    more = int(_numbers(words[9 + count :], 1)[0])
    rest = words[10 + count + max(0, more) :]
    numbers = _numbers(rest, 12)
    scan = Scan(first, step, _ranges(ranges, farthest), farthest)
    return LoggedScan(scan, Pose(*numbers[:3]), Pose(*numbers[3:6]), wheels, numbers[11])
