"""Quality of a face image for identification; if it is too low, the reason in plain words."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tangy_hw.perception.faces.face_detector import Box, Grey

SIDE = 64  # pixels of width at which sharpness is measured
FINE, COARSE = 1.0, 4.0  # pixels: sigma of the two blurs that are compared


@dataclass(frozen=True, slots=True)
class FaceQualityLimits:
    """Minimum quality of a face."""

    size: float = 24  # pixels across
    sharpness: float = 0.2
    darkest: float = 30  # of 255
    brightest: float = 235
    contrast: float = 17  # of 255: standard deviation of brightness
    evenness: float = 0.55  # of 1: ratio of the darker to the brighter half
    symmetry: float = 0.75


USUAL = FaceQualityLimits()


@dataclass(frozen=True, slots=True)
class Quality:
    """Quality of a face: pixels across, and the rest as in `FaceQualityLimits`."""

    size: float
    sharpness: float
    brightness: float
    contrast: float
    evenness: float
    symmetry: float

    def problem(self, limits: FaceQualityLimits = USUAL) -> str:
        """Return why the quality is too low; "" if it is not."""
        if self.size < limits.size:
            return f"the face is too small ({self.size:.0f} pixels across): come closer"
        if self.brightness < limits.darkest:
            return "the face is too dark: more light from the front"
        if self.brightness > limits.brightest:
            return "the face is too bright: less light on it"
        if self.sharpness < limits.sharpness:
            return "the face is blurred: hold still, or clean the lens"
        if self.contrast < limits.contrast:
            return "the face has hardly any contrast: more light from the front"
        if self.evenness < limits.evenness:
            return "one side of the face is in the dark: more light from the front"
        if self.symmetry < limits.symmetry:
            return "the face is turned away: look at the camera"
        return ""

    def document(self) -> dict[str, float]:
        """Return it as JSON: size in px, brightness and contrast of 255, ratios."""
        return {name: round(value, 3) for name, value in asdict(self).items()}


def judge(grey: Grey, box: Box, face: Grey) -> Quality:
    """Measure the quality of a face, in its image and aligned."""
    import numpy as np

    from tangy_hw.perception.faces.face_embedding import symmetry

    inner = face[8:-8, 8:-8].astype(np.float32)
    half = inner.shape[1] // 2
    left, right = float(inner[:, :half].mean()) + 1, float(inner[:, -half:].mean()) + 1
    return Quality(
        box[2],
        _sharpness(grey, box),
        float(inner.mean()),
        float(inner.std()),
        min(left, right) / max(left, right),
        symmetry(face),
    )


def _sharpness(grey: Grey, box: Box) -> float:
    """Compare fine with coarse differences; a ratio depends little on the light."""
    import cv2

    x, y, w, h = (round(value) for value in box)
    part: Any = grey[max(0, y) : y + h, max(0, x) : x + w]
    if min(part.shape) < 8:
        return 0.0
    if part.shape[1] > SIDE:
        size = (SIDE, max(1, round(part.shape[0] * SIDE / part.shape[1])))
        part = cv2.resize(part, size, interpolation=cv2.INTER_AREA)
    light = part.astype("float32")
    fine = (light - cv2.GaussianBlur(light, (0, 0), FINE)).std()
    coarse = (light - cv2.GaussianBlur(light, (0, 0), COARSE)).std()
    return float(fine / coarse) if coarse > 1 else 0.0
