"""Former name of `tangy_hw.robot_process`, for programs that start it by this name."""

from __future__ import annotations

from tangy_hw.robot_process.process import main

if __name__ == "__main__":
    main()
