"""No message from a bridge breaks the link or the devices behind it."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.device_protocols import Pose, Twist
from tangy_hw.drivers.ros_arms import RosArms
from tangy_hw.drivers.ros_base import RosBase
from tangy_hw.drivers.ros_laser import RosLaser
from tangy_hw.drivers.ros_messages import pose_message, twist_message
from tangy_hw.drivers.ros_navigator import RosNavigator
from tangy_hw.drivers.ros_status import RosDiagnostics, RosStopButton
from tangy_hw.drivers.ros_voice import RosVoice
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_profiles.health import STATES
from tangy_profiles.robot import Limb

POSE: dict[str, Any] = pose_message(Pose(1, 2, 0))
GOOD: dict[str, dict[str, Any]] = {
    "/odom": {"pose": {"pose": POSE}, "twist": {"twist": twist_message(Twist(1, 2))}},
    "/scan": {
        "angle_min": -1, "angle_increment": 0.1, "range_min": 0, "range_max": 5, "ranges": [1, 2]
    },
    "/stop_button": {"data": False},
    "/diagnostics": {"status": [{"name": "arms", "level": 0, "message": "", "values": []}]},
    "/joint_states": {"name": ["head/nod"], "position": [0.1]},
    "/voice/said": {"data": "hello"},
    "/move_base/status": {"status_list": [{"goal_id": {"id": "x"}, "status": 3, "text": ""}]},
    "/move_base/result": {"status": {"goal_id": {"id": "x"}, "status": 3}},
    "/move_base/feedback": {"feedback": {"base_position": {"pose": POSE}}},
    "/amcl_pose": {"pose": {"pose": POSE}},
}  # fmt: skip
JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=5)
    | st.just(10**400),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=6,
)


@st.composite
def spoilt(draw: st.DrawFn) -> tuple[str, Any]:
    """Return a topic, and a message of it with one changed part."""
    topic = draw(st.sampled_from(sorted(GOOD)))
    message = json.loads(json.dumps(GOOD[topic]))
    here: Any = message
    while True:
        keys = list(here) if isinstance(here, dict) else list(range(len(here)))
        key = draw(st.sampled_from(keys))
        inner = here[key]
        if not (isinstance(inner, dict | list) and inner) or draw(st.booleans()):
            here[key] = draw(JSON)
            return topic, message
        here = inner


@pytest.mark.slow
@given(st.lists(spoilt(), min_size=5, max_size=20))
def test_messages_with_a_corrupt_field_are_ignored(messages: list[tuple[str, Any]]) -> None:
    async def run() -> None:
        told: list[str] = []
        bridge = Rosbridge("ws://127.0.0.1:9", tell=told.append)
        diagnostics = RosDiagnostics(bridge)
        limbs = {"head": Limb("head", ("nod",), (-30,), (30,))}
        base, laser = RosBase(bridge, diagnostics=diagnostics), RosLaser(bridge)
        button, voice, navigator = RosStopButton(bridge), RosVoice(bridge), RosNavigator(bridge)
        arms = RosArms(bridge, limbs, diagnostics=diagnostics)
        devices = (diagnostics, base, laser, button, arms, voice, navigator)
        for device in devices:
            await device.start()
        for topic, message in messages:
            bridge.hear(json.dumps({"op": "publish", "topic": topic, "msg": message}))
        for topic, message in GOOD.items():
            bridge.hear(json.dumps({"op": "publish", "topic": topic, "msg": message}))
        for reading in (device.reading() for device in devices):
            assert reading.state in STATES
            assert reading.age >= 0
        assert base.odometry is not None
        assert base.odometry.value.pose[:2] == (1, 2)
        assert laser.scan is not None
        assert laser.scan.value.ranges.tolist() == [1, 2]
        assert arms.positions == {"head/nod": 0.1}
        assert not button.latched
        assert len(told) == len(set(told))
        for device in devices:
            await device.close()
        await bridge.close()

    asyncio.run(run())


@given(st.one_of(JSON, st.dictionaries(st.sampled_from(("op", "id", "values", "data")), JSON)))
def test_invalid_messages_are_ignored(message: Any) -> None:
    bridge = Rosbridge("ws://127.0.0.1:9")
    bridge.hear(json.dumps(message))
    for op in ("fragment", "service_response", "action_result", "publish", "status"):
        if isinstance(message, dict):
            bridge.hear(json.dumps({**message, "op": op}))
