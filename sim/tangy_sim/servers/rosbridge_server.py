"""A rosbridge v2 server: topics, services and actions as JSON over WebSocket.

It knows nothing of robots: the simulation publishes, subscribes, and provides services. Messages to
a client keep their order, so messages published before a service's answer arrive before it. A
client that does not read delays nobody: its oldest messages are dropped.
"""

from __future__ import annotations

import asyncio
import json
import time
from collections import Counter
from collections.abc import Callable, Collection, Coroutine, Mapping
from contextlib import suppress
from typing import Any

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.exceptions import ConnectionClosed

from tangy_sim.servers.rosbridge_client import Client, encoded, full_name

Message = Mapping[str, Any]
Hears = Callable[[Message], None]
Feedback = Callable[[Message], None]
Service = Callable[[Message], Coroutine[Any, Any, Message]]
Action = Callable[[Message, Feedback], Coroutine[Any, Any, Message]]

LARGEST = 16 << 20  # bytes of a received message
CLOSING_SECONDS = 0.5  # timeout of a client's closing handshake
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6  # by their number in action_msgs/GoalStatus


class RosbridgeServer:
    """Serves topics, services and actions to any number of clients."""

    def __init__(
        self,
        host: str = "127.0.0.1",
        port: int = 0,
        *,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Set the address (port 0: any free one), and the clock for throttling."""
        self.host, self.port = host, port
        self.sent: Counter[str] = Counter()
        """Number of messages published so far, by topic."""
        self._clock = clock
        self._server: Server | None = None
        self._clients: set[Client] = set()
        self._hears: dict[str, list[Hears]] = {}
        self._services: dict[str, Service] = {}
        self._actions: dict[str, Action] = {}
        self._goals: dict[str, asyncio.Future[Any]] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._paused = False
        self._still: frozenset[str] = frozenset()
        self._changed = asyncio.Event()

    @property
    def url(self) -> str:
        """Address for clients."""
        return f"ws://{self.host}:{self.port}"

    async def start(self) -> None:
        """Start to listen; after `close`, at the same port again.

        Raises:
            OSError: the port is in use.
        """
        self._server = await serve(
            self._attend,
            self.host,
            self.port,
            compression=None,
            max_size=LARGEST,
            ping_interval=None,
            close_timeout=CLOSING_SECONDS,
        )
        self.port = next(iter(self._server.sockets)).getsockname()[1]

    async def close(self) -> None:
        """Stop: nothing more is answered, and all connections are closed."""
        server, self._server = self._server, None
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        if server is not None:
            server.close()
            await server.wait_closed()

    def drop(self) -> None:
        """Abort all connections, as in a crash, and go on listening."""
        for client in self._clients:
            client.connection.transport.abort()

    def pause(self, still: Collection[str] = ()) -> None:
        """Freeze: connections stay open, but nothing is sent or done until `resume`.

        Messages published meanwhile are lost; clients' messages are processed afterwards, as in a
        process that was stopped and continued. `still` names topics and services that go on.
        """
        self._paused, self._still = True, frozenset(map(full_name, still))

    def resume(self) -> None:
        """End a pause."""
        self._paused = False
        for client in list(self._clients):
            held, client.held = client.held, []
            for message in held:
                self._do(client, message)
            for text in client.unsaid:
                client.say(text)
            client.unsaid.clear()

    def publish(self, topic: str, kind: str, message: Message) -> None:
        """Send a message to all subscribers, without waiting.

        Args:
            topic: name of the topic.
            kind: message type, for the reader only; rosbridge does not send it.
            message: may contain numpy arrays; NaN and infinity become null, as in rosbridge.
        """
        del kind
        topic = full_name(topic)
        self.sent[topic] += 1
        if self._silent(topic):
            return
        text, now = "", self._clock()
        for client in self._clients:
            if client.is_due(topic, now):
                text = text or encoded({"op": "publish", "topic": topic, "msg": message})
                client.say(text, loses=True, largest=client.largest(topic))

    def on_message(self, topic: str, hears: Hears) -> None:
        """Add a callback for messages that clients publish on a topic."""
        self._hears.setdefault(full_name(topic), []).append(hears)

    def provide(self, service: str, does: Service) -> None:
        """Provide a service: arguments in, values out; an exception is a failure."""
        self._services[full_name(service)] = does

    def provide_action(self, action: str, does: Action) -> None:
        """Provide an action: goal and feedback callback in, result out.

        An exception aborts it; a client's cancellation cancels its task.
        """
        self._actions[full_name(action)] = does

    def is_subscribed(self, topic: str) -> bool:
        """Whether any client has subscribed to a topic."""
        return any(full_name(topic) in client.topics for client in self._clients)

    async def subscribed(self, *topics: str) -> None:
        """Wait until each of some topics has a subscriber."""
        while not all(map(self.is_subscribed, topics)):
            self._changed.clear()
            await self._changed.wait()

    def _silent(self, name: str) -> bool:
        return self._paused and name not in self._still

    async def _attend(self, connection: ServerConnection) -> None:
        client = Client(connection)
        self._clients.add(client)
        writing = asyncio.create_task(client.write())
        try:
            with suppress(ConnectionClosed):
                async for text in connection:
                    self._hear(client, text)
        finally:
            self._clients.discard(client)
            writing.cancel()  # a goal goes on without its client, as in ROS
            self._changed.set()
            await asyncio.gather(writing, return_exceptions=True)

    def _hear(self, client: Client, text: str | bytes) -> None:
        try:
            message = json.loads(text)
            if not isinstance(message, dict) or not isinstance(message.get("op"), str):
                raise ValueError("a message is an object with an `op`")
        except (ValueError, RecursionError) as error:
            client.say(_status("error", f"not understood: {error}"))
            return
        name = next((message[key] for key in ("topic", "service", "action") if key in message), "")
        if not self._silent(full_name(str(name))):
            self._do(client, message)
        else:
            client.hold(message)

    def _do(self, client: Client, message: dict[str, Any]) -> None:
        does = {
            "subscribe": self._subscribe,
            "unsubscribe": self._unsubscribe,
            "publish": self._published,
            "advertise": lambda *_: None,
            "unadvertise": lambda *_: None,
            "call_service": self._called,
            "send_action_goal": self._sought,
            "cancel_action_goal": self._cancelled,
        }.get(message["op"])
        if does is None:
            client.say(_status("error", f"unknown operation {message['op']}", message.get("id")))
            return
        try:
            does(client, message)
        except (KeyError, TypeError, ValueError) as error:
            client.say(_status("error", f"{message['op']}: {error!r}", message.get("id")))

    def _subscribe(self, client: Client, message: dict[str, Any]) -> None:
        client.subscribe(
            full_name(message["topic"]),
            str(message.get("id", "")),
            float(message.get("throttle_rate", 0)) / 1000,
            int(message.get("fragment_size") or 0),
        )
        self._changed.set()

    def _unsubscribe(self, client: Client, message: dict[str, Any]) -> None:
        client.unsubscribe(full_name(message["topic"]), message.get("id"))

    def _published(self, client: Client, message: dict[str, Any]) -> None:
        topic, content = full_name(message["topic"]), message["msg"]
        for hears in self._hears.get(topic, ()):
            hears(content)
        if self.is_subscribed(topic):
            self.publish(topic, "", content)

    def _called(self, client: Client, message: dict[str, Any]) -> None:
        name = full_name(message["service"])
        answer = {"op": "service_response", "service": message["service"]}
        if "id" in message:
            answer["id"] = message["id"]
        arguments = message.get("args") or {}

        async def run() -> None:
            try:
                values: Any = await self._services[name](arguments)
                self._answer(client, name, {**answer, "values": values, "result": True})
            except KeyError as error:
                why = (
                    f"service {name} does not exist" if name not in self._services else repr(error)
                )
                self._answer(client, name, {**answer, "values": why, "result": False})
            except Exception as error:  # the caller gets any exception of a service
                self._answer(client, name, {**answer, "values": str(error), "result": False})

        self._begin(run())

    def _sought(self, client: Client, message: dict[str, Any]) -> None:
        name, key = full_name(message["action"]), str(message["id"])
        base = {"action": message["action"], "id": message["id"]}

        def feed(values: Message) -> None:
            if message.get("feedback"):
                self._answer(client, name, {"op": "action_feedback", **base, "values": values})

        async def run() -> None:
            values: Any = {}
            status = SUCCEEDED
            try:
                values = await goal
            except asyncio.CancelledError:
                status = CANCELED
            except Exception as error:  # the client gets any exception of an action
                values, status = str(error), ABORTED
            self._goals.pop(key, None)
            result = {"values": values, "status": status, "result": status == SUCCEEDED}
            self._answer(client, name, {"op": "action_result", **base, **result})

        if name not in self._actions:
            raise ValueError(f"action {name} does not exist")
        goal = asyncio.ensure_future(self._actions[name](message.get("args") or {}, feed))
        self._goals[key] = goal
        self._begin(run())

    def _cancelled(self, _: Client, message: dict[str, Any]) -> None:
        goal = self._goals.get(str(message["id"]))
        if goal is not None:
            goal.cancel()

    def _answer(self, client: Client, name: str, answer: Message) -> None:
        text = encoded(answer)
        if self._silent(name):
            client.unsaid.append(text)
        else:
            client.say(text)

    def _begin(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)


def _status(level: str, text: str, about: object = None) -> str:
    return encoded({"op": "status", "level": level, "msg": text, "id": about})
