"""Start the robot process: `python -P -m tangy_hw.robot_process PID`."""

from __future__ import annotations

from tangy_hw.robot_process.process import main

if __name__ == "__main__":
    main()
