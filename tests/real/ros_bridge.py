"""A rosbridge for tests: between a ROS 1 master and WebSocket clients, by Debian's rospy.

`/usr/bin/python3 ros_bridge.py PORT` with ROS_MASTER_URI set; it prints its port when it listens.
It knows topics and services, as far as the drivers need them; messages are written as by
rosbridge: bytes in base64, infinite values and NaN as null, times as secs and nsecs.
"""

from __future__ import annotations

import base64
import json
import math
import sys
import threading
from contextlib import suppress
from typing import Any

import genpy  # type: ignore[import-not-found]
import roslib.message  # type: ignore[import-not-found]
import rospy  # type: ignore[import-not-found]
import rosservice  # type: ignore[import-not-found]
import rostopic  # type: ignore[import-not-found]
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import ServerConnection, serve

PUBLISHERS: dict[str, tuple[Any, Any]] = {}
LOCK = threading.Lock()


def as_json(value: Any) -> Any:
    """Return a message, or a part of one, as rosbridge writes it."""
    if isinstance(value, genpy.Message):
        return {slot: as_json(getattr(value, slot)) for slot in value.__slots__}
    if isinstance(value, genpy.TVal):
        return {"secs": value.secs, "nsecs": value.nsecs}
    if isinstance(value, bytes):
        return base64.b64encode(value).decode()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return list(map(as_json, value)) if isinstance(value, list | tuple) else value


def filled(message: Any, values: Any) -> Any:
    """Fill a message in; an unknown field is an error, as in rosbridge."""
    kinds = dict(zip(message.__slots__, message._slot_types, strict=True))
    for name, value in values.items():
        setattr(message, name, made(kinds[name], value))
    return message


def made(kind: str, value: Any) -> Any:
    """Make a field of a message."""
    if kind.endswith("]"):
        return [made(kind.partition("[")[0], part) for part in value]
    if kind in ("time", "duration"):
        return (genpy.Time if kind == "time" else genpy.Duration)(value["secs"], value["nsecs"])
    if "/" in kind or kind == "Header":
        return filled(roslib.message.get_message_class(kind)(), value)
    return float(value) if kind.startswith("float") else value


def publisher(topic: str, kind: str = "") -> tuple[Any, Any]:
    """Return the publisher of a topic, and its message class."""
    with LOCK:
        if topic not in PUBLISHERS:
            kind = kind or rostopic.get_topic_type(topic)[0]
            made_of = roslib.message.get_message_class(kind)
            PUBLISHERS[topic] = rospy.Publisher(topic, made_of, queue_size=20), made_of
        return PUBLISHERS[topic]


def attend(connection: ServerConnection) -> None:
    """Serve one client until it disconnects."""
    subscribers: dict[str, Any] = {}

    def send(message: dict[str, Any]) -> None:
        with suppress(ConnectionClosed):
            connection.send(json.dumps(message))

    def do(message: dict[str, Any]) -> None:
        topic = message.get("topic", "")
        if message["op"] == "advertise":
            publisher(topic, message["type"])
        elif message["op"] == "publish":
            who, kind = publisher(topic)
            who.publish(filled(kind(), message["msg"]))
        elif message["op"] == "subscribe" and topic not in subscribers:
            kind = roslib.message.get_message_class(message["type"])
            if kind is None:
                raise ValueError(f"there is no type {message['type']}")
            subscribers[topic] = rospy.Subscriber(
                topic,
                kind,
                lambda said: send({"op": "publish", "topic": topic, "msg": as_json(said)}),
            )
        elif message["op"] == "unsubscribe" and topic in subscribers:
            subscribers.pop(topic).unregister()
        elif message["op"] == "call_service":
            service = message["service"]
            answer = {"op": "service_response", "id": message.get("id"), "service": service}
            kind = rosservice.get_service_class_by_name(service)
            request = filled(kind._request_class(), message.get("args") or {})
            values = rospy.ServiceProxy(service, kind)(request)
            send({**answer, "values": as_json(values), "result": True})

    try:
        for text in connection:
            message = json.loads(text)
            try:
                do(message)
            except Exception as error:
                send({"op": "status", "level": "error", "msg": repr(error)})
    except ConnectionClosed:
        pass
    finally:
        for subscriber in subscribers.values():
            subscriber.unregister()


def main() -> None:
    """Listen until the process is killed."""
    rospy.init_node("bridge", anonymous=True, disable_signals=True)
    with serve(attend, "127.0.0.1", int(sys.argv[1]), compression=None) as server:
        print(server.socket.getsockname()[1], flush=True)
        server.serve_forever()


if __name__ == "__main__":
    main()
