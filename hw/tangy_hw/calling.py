"""Calls a person by a command, an HTTP address or an MQTT topic, and receives the answer.

A command gets the message as JSON on standard input, an address by POST, and a topic as its
payload. An answer is a line of the command's output that begins with "answered", such a text or
{"answered": "who"} in the HTTP reply, or any message to the topic with /answer appended. Delivery
of the message is not an answer.
"""

from __future__ import annotations

import json
import subprocess
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import IO, Any, Literal
from urllib.parse import unquote, urlsplit

from tangy_profiles.contacts import Contact
from tangy_profiles.reading import plain

Stage = Literal["sent", "answered", "failed"]
"""Outcome of a call."""

ANSWERED = "answered"
LONGEST = 4_000  # bytes of an answer
CONNECT_SECONDS = 10.0
WORDS = 160  # characters of a message that are kept


@dataclass(frozen=True, slots=True)
class CallNews:
    """Outcome of a call; `said` is the answer, or why it failed."""

    stage: Stage
    said: str = ""


OnNews = Callable[[CallNews], None]


def call(contact: Contact, message: Mapping[str, Any], seconds: float, told: OnNews) -> None:
    """Send a message to a person, and wait up to `seconds` s for an answer.

    `told` receives the outcome, at the latest at the timeout; nothing is raised.
    """
    try:
        if contact.command:
            _by_command(contact.command, message, seconds, told)
        elif contact.url.startswith(("http://", "https://")):
            _by_post(contact.url, message, seconds, told)
        else:
            _by_topic(contact.url, message, seconds, told)
    except Exception as error:  # the caller has to hear of any failure
        told(CallNews("failed", _short(str(error) or type(error).__name__)))


def _by_command(
    command: tuple[str, ...], message: Mapping[str, Any], seconds: float, told: OnNews
) -> None:
    process = subprocess.Popen(  # noqa: S603 - the facility's own command, from its robot's file
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    ending = threading.Timer(seconds, process.kill)
    ending.start()
    try:
        assert process.stdin and process.stdout and process.stderr  # noqa: S101 - they are pipes
        with suppress(BrokenPipeError):  # a command that reads no message
            process.stdin.write(json.dumps(dict(message)).encode() + b"\n")
            process.stdin.close()
        answered = _first_answer(process.stdout)
        if answered is not None:
            told(CallNews("answered", answered))
            return
        wrong = process.stderr.read(LONGEST)
        status = process.wait()
    finally:
        ending.cancel()
        process.kill()
        process.wait()
    if status == 0:
        told(CallNews("sent"))
        return
    how = "it took too long" if status < 0 else f"it ended with status {status}"
    lines = wrong.decode("utf-8", "replace").strip().splitlines()
    told(CallNews("failed", _short(f"{how}: {lines[-1]}" if lines else how)))


def _first_answer(lines: IO[bytes]) -> str | None:
    for line in iter(lambda: lines.readline(LONGEST), b""):
        said = _answer_in(line)
        if said is not None:
            return said
    return None


def _by_post(url: str, message: Mapping[str, Any], seconds: float, told: OnNews) -> None:
    from urllib.error import HTTPError, URLError  # slow to import, and few robots need them
    from urllib.request import Request, urlopen

    body = json.dumps(dict(message)).encode()
    request = Request(url, body, {"Content-Type": "application/json"})  # noqa: S310 - http alone
    try:
        with urlopen(request, timeout=seconds) as reply:  # noqa: S310 - http alone
            said = _answer_in(reply.read(LONGEST))
    except HTTPError as error:
        told(CallNews("failed", f"the address replied with status {error.code}"))
        return
    except URLError as error:
        why = getattr(error.reason, "strerror", None) or error.reason
        told(CallNews("failed", _short(f"the address cannot be reached: {why}")))
        return
    told(CallNews("sent") if said is None else CallNews("answered", said))


def _by_topic(url: str, message: Mapping[str, Any], seconds: float, told: OnNews) -> None:
    try:
        from paho.mqtt import client as mqtt
        from paho.mqtt.enums import CallbackAPIVersion
    except ImportError:
        raise ValueError(
            "calling by MQTT needs the package paho-mqtt: pip install 'tangy[mqtt]'"
        ) from None
    parts = urlsplit(url)
    topic, until = unquote(parts.path).strip("/"), time.monotonic() + seconds
    answers: list[str] = []
    come = threading.Event()

    def heard(_client: Any, _data: Any, one: Any) -> None:
        if not one.retain:
            answers.append(_short(bytes(one.payload[:LONGEST]).decode("utf-8", "replace")))
            come.set()

    client = mqtt.Client(CallbackAPIVersion.VERSION2)
    if parts.username:
        client.username_pw_set(unquote(parts.username), unquote(parts.password or ""))
    if parts.scheme == "mqtts":
        client.tls_set()
    client.on_message = heard
    client.connect_timeout = min(CONNECT_SECONDS, seconds)
    client.connect(parts.hostname or "", parts.port or (8883 if parts.scheme == "mqtts" else 1883))
    client.loop_start()
    try:
        client.subscribe(f"{topic}/answer", qos=1)
        sent = client.publish(topic, json.dumps(dict(message)), qos=1)
        sent.wait_for_publish(max(0.1, until - time.monotonic()))
        if not sent.is_published():
            raise ValueError("the broker did not take the message")
        told(CallNews("sent"))
        if come.wait(max(0.0, until - time.monotonic())):
            told(CallNews("answered", answers[0]))
    finally:
        client.disconnect()
        client.loop_stop()


def _answer_in(said: bytes) -> str | None:
    """Return the words of a reply if a person answered, else None."""
    text = said.decode("utf-8", "replace").strip()
    with suppress(ValueError, RecursionError):
        value = json.loads(text)
        if isinstance(value, dict):
            answer = value.get(ANSWERED)
            return _short(answer) if isinstance(answer, str) else "" if answer is True else None
    if not text.casefold().startswith(ANSWERED):
        return None
    return _short(text[len(ANSWERED) :].lstrip(" :,.\t").rstrip())


def _short(said: str) -> str:
    words = plain(" ".join(said.split()))
    return words if len(words) <= WORDS else f"{words[: WORDS - 3]}..."
