"""The former name of `tangy_hw.robot_process`, by which other programs may start it."""

from __future__ import annotations

from tangy_hw.robot_process.process import main

if __name__ == "__main__":
    main()
