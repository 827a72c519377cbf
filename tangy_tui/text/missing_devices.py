"""Words for a robot's missing devices, shown once before a game."""

from __future__ import annotations

from tangy_profiles.activity import Activity
from tangy_profiles.known_devices import left_out, missing_devices, reads_cards
from tangy_profiles.robot import Robot

ALL_SHOWN = "This robot has no loudspeaker: Tangy shows everything on its screen."
ALL_SAID = "This robot has no screen: Tangy says everything."
NEITHER = "This robot has neither a loudspeaker nor a screen: nobody could follow the game."
NO_BUTTON = (
    "Tangy does not notice whether this robot's emergency stop is pressed. If you press it, stop "
    "the game here as well."
)
NO_REQUESTS = "This robot does not see who asks for help: type it, as in ask for Rosa."
STANDS_OFF = "The robot stands still, and is off."
UNTIL_AGAIN = "If you go on, this holds until you start the program again."
NO_ARMS = "This robot has no arms: Tangy makes no gestures."


def missing_words(robot: Robot, activity: Activity) -> list[str]:
    """Describe each missing device in a sentence, and what Tangy does instead.

    Args:
        robot: the robot, without devices that have no driver.
        activity: the activity that it plays.
    """
    missing = missing_devices(robot)
    labels = {device.name: device.label for device in robot.undriven}
    told = []
    for name in missing:
        match name:
            case "stop_button":
                told.append(NO_BUTTON)
            case "camera":
                pass  # what matters is whether anything reads cards: below
            case "requests":
                told.append(NO_REQUESTS)
            case "voice":
                told.append(NEITHER if "screen" in missing else ALL_SHOWN)
            case "screen":
                told += [] if "voice" in missing else [ALL_SAID]
            case "arms":
                told.append(NO_ARMS)
            case _:
                told.append(f"This robot has no {labels.get(name, name)}.")
    if activity.deck.columns and not reads_cards(robot):
        told.append(no_camera_words(activity.object))
    return told


def go_on_without(robot: Robot, device: str) -> str:
    """Ask whether to switch a robot on without a device that does not start."""
    return f"Go on without the {robot.devices[device].label}?"


def without_words(robot: Robot, device: str, activity: Activity, why: str) -> str:
    """Tell `why` a device does not start, and what Tangy does without it.

    Args:
        robot: the robot, which has the device.
        device: the name of the device.
        activity: the activity that it plays.
        why: a sentence.
    """
    before = missing_words(robot, activity)
    new = [one for one in missing_words(left_out(robot, device), activity) if one not in before]
    return " ".join([why, STANDS_OFF, *new, UNTIL_AGAIN])


def no_camera_words(object: str) -> str:
    """Tell that only staff can read people's cards."""
    return f"This robot has no camera that sees a {object}: Tangy asks you how each one is."


def staff_needed(object: str) -> str:
    """Tell that nobody can read people's cards."""
    return (
        f"This robot has no camera that sees a {object}, and nobody is here to look instead: play "
        "with --plain or on the screen, or name a camera's source in the robot's file."
    )
