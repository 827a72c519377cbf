"""MRPT's pf-localization on the same scans as Tangy: its input files, and its results."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Sequence
from math import hypot, pi
from pathlib import Path

import numpy as np

from tangy_hw.navigation.map_files import write_map
from tangy_hw.navigation.occupancy import OccupancyMap
from tests.bench.localisation import Moment

PROGRAMS = ("pf-localization", "carmen2rawlog", "ros-map-yaml2mrpt")
MISSED = 81.91  # metres: a SICK scanner's value for a beam without a return
PATIENCE = 400  # seconds

SETTINGS = """
[KLD_options]
KLD_binSize_PHI_deg = 10
KLD_binSize_XY = 0.5
KLD_delta = 0.01
KLD_epsilon = 0.05
KLD_minSampleSize = 300
KLD_maxSampleSize = 2000
KLD_minSamplesPerBin = 0

[PF_options]
PF_algorithm = 0
resamplingMethod = 0
adaptiveSampleSize = 1
BETA = 0.5
sampleSize = 1

[DummyOdometryParams]
minStdXY = 0.05
minStdPHI = 2.0

[LocalizationExperiment]
use_3D_poses = false
map_file = {map}
rawlog_file = {scans}
logOutput_dir = {out}
3DSceneFrequency = -1
experimentRepetitions = 1
particles_count = 500
init_PDF_mode = 1
init_PDF_min_x = {left}
init_PDF_max_x = {right}
init_PDF_min_y = {near}
init_PDF_max_y = {far}
init_PDF_min_yaw_deg = {low}
init_PDF_max_yaw_deg = {high}
SHOW_PROGRESS_3D_REAL_TIME = false

[MetricMap]
occupancyGrid_count = 1
pointsMap_count = 0
likelihoodMapSelection = -1

[MetricMap_occupancyGrid_00_creationOpts]
resolution = {resolution}

[MetricMap_occupancyGrid_00_likelihoodOpts]
likelihoodMethod = 4
LF_decimation = 6
LF_stdHit = {sigma}
LF_maxCorrsDistance = 0.50
LF_zHit = 0.95
LF_zRandom = 0.05
LF_maxRange = 20
LF_alternateAverageMethod = 0
"""


def mrpt_errors(
    map_: OccupancyMap, way: Sequence[Moment], folder: Path, sigma: float = 0.35
) -> list[float]:
    """Let MRPT follow a drive from its beginning; return its errors in metres, scan by scan.

    It has as many particles and beams as Tangy: 300 to 2000, and 60.
    """
    write_map(map_, folder / "map.yaml")
    _run(folder, "ros-map-yaml2mrpt", "-q", "-w", "-i", "map.yaml")
    (folder / "scans.log").write_text("".join(_lines(way)))
    _run(folder, "carmen2rawlog", "-q", "-w", "-i", "scans.log", "-o", "scans.rawlog")
    start = way[0].truth
    degrees = start.heading * 180 / pi
    settings = SETTINGS.format(
        map="map.gridmap.gz", scans="scans.rawlog", out="out", resolution=map_.resolution,
        left=start.x - 0.2, right=start.x + 0.2, near=start.y - 0.2, far=start.y + 0.2,
        low=degrees - 5, high=degrees + 5, sigma=sigma,
    )  # fmt: skip
    (folder / "settings.ini").write_text(settings)
    said = _run(folder, "pf-localization", "settings.ini")
    found = re.findall(r"PDF estimation: \(([-\d.e]+),([-\d.e]+),", said)
    places = np.array(found, dtype=float)
    return [hypot(x - one.truth.x, y - one.truth.y)
            for (x, y), one in zip(places, way, strict=False)]  # fmt: skip


def _lines(way: Sequence[Moment]) -> list[str]:
    lines = []
    for number, one in enumerate(way):
        # one empty reading more: then they reach from -90 to +90 degrees in half degrees
        ranges = [*np.where(np.isfinite(one.scan.ranges), one.scan.ranges, MISSED), MISSED]
        pose = " ".join(f"{value:.6f}" for value in one.odometry)
        stamp = f"{1000 + number * 0.4:.6f}"
        told = " ".join(f"{value:.3f}" for value in ranges)
        lines.append(f"ODOM {pose} 0 0 0 {stamp} robot {stamp}\n")
        lines.append(f"FLASER {len(ranges)} {told} {pose} {pose} {stamp} robot {stamp}\n")
    return lines


def _run(folder: Path, *command: str) -> str:
    done = subprocess.run(  # noqa: S603 - MRPT's own programs, by name
        command, cwd=folder, capture_output=True, text=True, timeout=PATIENCE, input="\n",
        check=True,
    )  # fmt: skip
    return done.stdout + done.stderr
