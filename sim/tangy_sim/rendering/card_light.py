"""Lighting of the simulated table, and the effects of a camera: blur, noise and JPEG."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tangy_profiles.card_face import HEIGHT, WIDTH

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from tangy_sim.rendering.card_frames import View

    Picture = NDArray[Any]
    Real = NDArray[Any]


def project(plane: NDArray[Any], points: NDArray[Any]) -> NDArray[Any]:
    """Project points (n, 2) of the card, in mm, into the image, in px."""
    import numpy as np

    seen = np.column_stack([points, np.ones(len(points))]) @ plane.T
    there: NDArray[Any] = seen[:, :2] / seen[:, 2:]
    return there


def lit_scene(scene: Real, plane: NDArray[Any], view: View, random: np.random.Generator) -> Real:
    """Return the scene (BGR) in the light of a view: its slope, warmth, shadow and glare."""
    import cv2
    import numpy as np

    height, width = scene.shape[:2]
    y, x = np.mgrid[0:height:8, 0:width:8].astype(np.float32)
    angle = random.uniform(0, 2 * np.pi)
    across = (x - width / 2) / width * np.cos(angle) + (y - height / 2) / width * np.sin(angle)
    field = view.light * (1 + view.slope * across * 2)
    middle = project(plane, np.array([[WIDTH / 2, HEIGHT / 2]]))[0]
    card = np.hypot(*(project(plane, np.array([[WIDTH, HEIGHT / 2]]))[0] - middle)) + 10
    dark: Real = np.zeros((), np.float32)
    if view.shadow:
        angle = random.uniform(0, 2 * np.pi)
        edge = (x - middle[0]) * np.cos(angle) + (y - middle[1]) * np.sin(angle)
        edge = edge - random.uniform(-1, 1) * card
        edge = cv2.resize(edge.astype(np.float32), (width, height))
        dark = view.shadow / (1 + np.exp(np.clip(-edge / view.soft, -30, 30)))
    shine = np.zeros_like(x)
    if view.glare:
        spot = middle + random.uniform(-1.2, 1.2, 2) * card
        far = ((x - spot[0]) ** 2 + (y - spot[1]) ** 2) / (card * random.uniform(0.06, 0.6)) ** 2
        shine = view.glare * np.exp(-far)
    field = (cv2.resize(field.astype(np.float32), (width, height)) * (1 - dark))[..., None]
    tint = np.array([1 - view.warm, 1, 1 + view.warm], np.float32)
    lit = scene * field * tint
    if view.glare:
        lit = lit + cv2.resize(shine.astype(np.float32), (width, height))[..., None]
    return np.asarray(lit, np.float32)


def moved(scene: Real, length: float, random: np.random.Generator) -> Real:
    """Blur along a line of `length` pixels, as a moving camera does."""
    import cv2
    import numpy as np

    angle, side = random.uniform(0, np.pi), 2 * int(np.ceil(length)) + 1
    kernel = np.zeros((side, side), np.float32)
    for step in np.linspace(-length / 2, length / 2, 21):
        x, y = side // 2 + step * np.cos(angle), side // 2 + step * np.sin(angle)
        kernel[round(y), round(x)] += 1
    return np.asarray(cv2.filter2D(scene, -1, kernel / kernel.sum()), np.float32)


def exposed(
    lit: Real, noise: float, quality: int, random: np.random.Generator, *, grey: bool = False
) -> Picture:
    """Return the camera's image: noise in grey levels, JPEG quality in %."""
    import cv2
    import numpy as np

    sigma = noise / 255 * np.sqrt(0.35 + lit)
    grain = random.standard_normal(lit.shape, np.float32)
    picture = np.clip((lit + sigma * grain) * 255, 0, 255).astype(np.uint8)
    if grey:
        picture = np.dstack([cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)] * 3)
    if quality < 100:
        _, packed = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])
        unpacked = cv2.imdecode(packed, cv2.IMREAD_COLOR)
        picture = picture if unpacked is None else np.asarray(unpacked, np.uint8)
    return picture
