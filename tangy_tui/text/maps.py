"""Words for a map made from a log."""

from __future__ import annotations

from tangy_profiles.reading import plain

DRIVE_MODE = "map"
DRIVES = "drive"
DRIVE_ON = "drive on"
DONE = "draw the map"
GO_ON = "go on"
LEAVE = "leave"
STOPPED = "stopped"
STOPPED_HERE = "You stopped Tangy. Press g to go on."
HOW_TO_DRIVE = (
    "Drive round the room, along its walls, and come back to places you have been. Hold an arrow "
    "key to drive. Press enter when the walls are complete."
)
OVER = "Is the drive over?"
OVER_DETAIL = "Tangy then matches the scans and draws the map. The scans are kept."
NOTHING_YET = "Nothing is recorded yet. Leave without a map?"
DRIVE_HELP = (
    "Hold ↑ or ↓ to drive, ← or → to turn. Space stops, enter ends the drive.\n\n"
    "Tangy slows down near people and things that its laser scanner sees, and stops before it "
    "reaches them. It cannot see behind itself or over its scanner: look there yourself. If it "
    "stands although there is room, Shift+↑ and Shift+↓ move it at a crawl, whatever is near.\n\n"
    "The picture follows the wheels, so its walls may be bent. When the drive is over, Tangy "
    "matches the scans and straightens them. It can do that where the robot has come back to a "
    "place it had seen, so drive in loops. Ask people to leave the room: anyone who stands in it "
    "becomes part of the map."
)

DRIVE_NEEDS_YAML = "--drive: say where the map goes, as in --yaml room.yaml."
DRIVE_NEEDS_SCREEN = "--drive: you drive with the arrow keys, so this needs a terminal."
DRIVE_ALONE = "--drive records a new log: leave LOG, --room and --match out."


def drive_is_there(record: str, yaml: str) -> str:
    """Tell that the file of an earlier drive exists already."""
    return (
        f"{record} is there already. Draw its map with: tangy map {record} --match --yaml {yaml}. "
        "For a new drive, choose another name or delete that file."
    )


def recorded_words(scans: int, metres: float) -> str:
    """Tell how much of a drive (in metres) is recorded."""
    return f"{scans} {'scan' if scans == 1 else 'scans'} recorded, {metres:.1f} m driven"


def kept_words(log: str) -> str:
    """Tell where the scans of a drive are stored."""
    return plain(f"The scans are kept in {log}.")


BETTER = (
    "Give a log of a smaller area, one that often returns to places it has seen, or one that a "
    "mapping program has corrected, without --match."
)


def refusal(path: str, why: str, picture: str) -> str:
    """Tell why a matched map is rejected, what to do, and which picture shows it, if any."""
    shown = f" {picture} shows it." if picture else ""
    return plain(f"{path}: {why} {BETTER}{shown}")


def unknown_words() -> str:
    """Tell that it is unknown whether a map closes."""
    return (
        "nobody can tell whether the map closes. The robot came back to places, and no scan fits "
        "what it saw there before."
    )


def apart_words(metres: float, torn: int, closed: int) -> str:
    """Tell how far apart the copies of a place are (metres), with the scans for and against."""
    return (
        f"the map does not close. Where the robot came back to a place, its poses are {metres:.1f} "
        f"m apart ({torn} scans; {closed} agree), so walls stand in the map twice."
    )


def contradicted_words(share: float, most: float) -> str:
    """Tell which share of the beams contradicts a map, and the limit."""
    return (
        f"the map does not close. After matching, {share:.0%} of the beams contradict it (at most "
        f"{most:.0%} in a map that closed), so walls stand in it twice."
    )
