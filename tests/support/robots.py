"""Files of robots without some devices."""

from __future__ import annotations

from pathlib import Path

from tangy_profiles.robot import load_robot, shipped_robots


def robot_without(folder: Path, *devices: str, drivers: str = "") -> Path:
    """Write the shipped robot's file without some devices; `drivers` are added as TOML."""
    top, *entries = load_robot().file.read_text(encoding="utf-8").split("[[devices]]")
    last, rest = entries[-1].split("[[limbs]]", 1)
    entries[-1] = last
    kept = [e for e in entries if not any(f'name = "{name}"' in e for name in devices)]
    text = "[[devices]]".join([top, *kept]) + drivers + "\n[[limbs]]" + rest
    path = folder / f"without-{'-'.join(devices) or 'nothing'}.toml"
    path.write_text(text, encoding="utf-8")
    return path


SHIPPED = tuple(shipped_robots())
