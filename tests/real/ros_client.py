"""A client for tests of a rosbridge server: PyPI's roslibpy, as others would write it.

`python ros_client.py PORT` prints as JSON its received messages, replies, and its goal's result.
"""

from __future__ import annotations

import json
import sys
import threading
from typing import Any

import roslibpy  # type: ignore[import-not-found, import-untyped, unused-ignore]

SECONDS = 10


def main() -> None:
    """Talk to the server."""
    found: dict[str, Any] = {"feedback": []}
    heard, over = threading.Event(), threading.Event()
    ros = roslibpy.Ros(host="127.0.0.1", port=int(sys.argv[1]))
    ros.run(timeout=SECONDS)

    def hear(message: Any) -> None:
        found["odometry"] = dict(message)
        heard.set()

    def end(result: Any) -> None:
        found["result"] = {"status": result["status"].value, "values": result["values"]}
        over.set()

    odometry = roslibpy.Topic(ros, "/odom", "nav_msgs/Odometry", throttle_rate=50, queue_length=1)
    odometry.subscribe(hear)
    heard.wait(SECONDS)
    drive = roslibpy.Topic(ros, "/cmd_vel", "geometry_msgs/Twist")
    drive.advertise()
    drive.publish(roslibpy.Message({"linear": {"x": 0.5}, "angular": {"z": 0.1}}))
    add = roslibpy.Service(ros, "/add", "test/Add")
    found["sum"] = add.call(roslibpy.ServiceRequest({"a": 1, "b": 2}), timeout=SECONDS)["sum"]
    try:
        roslibpy.Service(ros, "/none", "test/None").call(roslibpy.ServiceRequest(), timeout=SECONDS)
    except roslibpy.core.ServiceException as error:
        found["refused"] = str(error)
    go = roslibpy.ActionClient(ros, "/navigate_to_pose", "nav2_msgs/NavigateToPose")
    goal = roslibpy.Goal({"far": 1})
    go.send_goal(goal, end, lambda told: found["feedback"].append(dict(told)), end)
    over.wait(SECONDS)
    print(json.dumps(found), flush=True)
    ros.terminate()


if __name__ == "__main__":
    main()
