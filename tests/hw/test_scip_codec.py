"""SCIP 2.0 as bytes: numbers, checksums, and the separation of replies."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.drivers.scip_codec import (
    LONGEST,
    ScipError,
    checked,
    checksum,
    decode,
    decode_all,
    joined,
    named,
    optics,
    parse,
    split,
    trouble,
)
from tangy_sim.servers.scip_session import measurement, number

BODIES = st.lists(
    st.binary(min_size=1, max_size=20).filter(lambda one: b"\n" not in one), min_size=1, max_size=4
)


class TestNumbers:
    @pytest.mark.parametrize(
        ("value", "written"), [(1234, b"CB"), (5432, b"1Dh"), (16000000, b"m2@0")]
    )
    def test_the_examples_of_the_specification_decode(self, value: int, written: bytes) -> None:
        assert decode(written) == value

    @given(st.integers(1, 5).flatmap(lambda n: st.tuples(st.just(n), st.integers(0, 64**n - 1))))
    def test_decoding_a_number_of_the_server_gives_it_back(self, case: tuple[int, int]) -> None:
        length, value = case
        assert decode(number(value, length)) == value

    @given(st.lists(st.integers(0, 64**3 - 1), max_size=90))
    def test_a_whole_measurement_is_read(self, values: list[int]) -> None:
        lines = measurement(np.array(values, np.int64), 3).splitlines()
        assert decode_all(joined(lines), 3).tolist() == values

    @pytest.mark.parametrize("written", [b"0 0", b"0p0", b"00\x80"])
    def test_characters_outside_the_code_are_refused(self, written: bytes) -> None:
        for read in (lambda: decode(written), lambda: decode_all(written, 3)):
            with pytest.raises(ScipError):
                read()

    def test_a_truncated_distance_is_refused(self) -> None:
        with pytest.raises(ScipError, match="cut off"):
            decode_all(b"0000", 3)


class TestReplies:
    @given(st.binary(min_size=1, max_size=64), st.data())
    def test_the_checksum_detects_a_flipped_bit(self, line: bytes, data: st.DataObject) -> None:
        whole = line + bytes([checksum(line)])
        assert checked(whole) == line
        place = data.draw(st.integers(0, len(whole) - 1))
        bit = data.draw(st.integers(0, 5))
        damaged = bytearray(whole)
        damaged[place] ^= 1 << bit
        with pytest.raises(ScipError, match="checksum"):
            checked(bytes(damaged))

    @given(st.lists(BODIES, max_size=5), st.lists(st.integers(0, 400), max_size=8))
    def test_replies_are_reassembled_from_pieces_of_any_size(
        self, bodies: list[list[bytes]], cuts: list[int]
    ) -> None:
        sent = [b"\n".join(lines) for lines in bodies]
        stream = b"".join(one + b"\n\n" for one in sent)
        places = sorted({0, len(stream), *(cut for cut in cuts if cut < len(stream))})
        got: list[bytes] = []
        rest = b""
        for begin, end in itertools.pairwise(places):
            whole, rest = split(rest + stream[begin:end])
            got += whole
        assert got == sent
        assert rest == b""

    def test_a_reply_without_an_end_is_refused(self) -> None:
        with pytest.raises(ScipError, match="without an end"):
            split(b"0" * (LONGEST + 1))

    def test_a_reply_is_echo_status_and_lines(self) -> None:
        reply = parse(b"MD0000035901000\n99b\n")
        assert (reply.echo, reply.status, reply.lines) == (b"MD0000035901000", "99", (b"",))
        assert parse(b"SCIP2.0\n0").status == "0"

    @pytest.mark.parametrize("came", [b"", b"QT", b"QT\n00Q", b"QT\n", b"QT\n\xff\xfe" + b"M"])
    def test_a_reply_without_a_valid_status_is_refused(self, came: bytes) -> None:
        with pytest.raises(ScipError):
            parse(came)

    @pytest.mark.parametrize("status", ["0L", "0M", "0E", "10", "21", "57", "97", "04"])
    def test_every_error_status_has_a_description(self, status: str) -> None:
        assert trouble(status)
        assert not trouble("00") and not trouble("99")


def line(text: str, *, with_semicolon: bool = False) -> bytes:
    body = text.encode()
    return body + b";" + bytes([checksum(body + b";" if with_semicolon else body)])


class TestProperties:
    RIGHT = ("MODL:URG-04LX(Hokuyo)", "DMIN:20", "DMAX:5600[mm]", "ARES:1024", "AMIN:44",
             "AMAX:725", "AFRT:384", "SCAN:600")  # fmt: skip

    @pytest.mark.parametrize("with_semicolon", [False, True])
    def test_properties_are_read_with_either_kind_of_checksum(self, with_semicolon: bool) -> None:
        said = [line(one, with_semicolon=with_semicolon) for one in self.RIGHT]
        read = optics(named([*said, b""]))
        assert (read.model, read.nearest, read.farthest) == ("URG-04LX", 0.02, 5.6)
        assert (read.first, read.last, read.front, read.rate) == (44, 725, 384, 10.0)
        assert read.step == pytest.approx(0.0061359, rel=1e-4)

    @pytest.mark.parametrize("wrong", ["DMAX:10", "ARES:0", "AMAX:44", "SCAN:0", "AMIN:x"])
    def test_impossible_properties_are_refused(self, wrong: str) -> None:
        facts = dict(named(line(one) for one in (*self.RIGHT, wrong)))
        with pytest.raises(ScipError):
            optics(facts)

    def test_a_damaged_property_is_refused(self) -> None:
        with pytest.raises(ScipError, match="checksum"):
            named([line("DMIN:20").replace(b"2", b"3")])
