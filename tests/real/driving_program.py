"""A program that drives a robot up and down, so that tests can end it in every way.

Its one argument is the setup of the robot process, as JSON.
"""

from __future__ import annotations

import sys

from tangy_hw.device_protocols import DeviceError
from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_setup import RobotSetup

LEFT, RIGHT = [2.0, 3.0, 1.57], [8.0, 3.0, 1.57]


def main() -> None:
    """Drive until the program is ended."""
    link = RobotLink(RobotSetup.from_json(sys.argv[1]))
    link.start()
    print("on", flush=True)
    while True:
        for place in (LEFT, RIGHT):
            try:
                link.do("go", to=place)
            except DeviceError as error:
                print(f"broken off: {error}", flush=True)
                link.release()


if __name__ == "__main__":
    main()
