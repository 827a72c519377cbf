"""Steps, policy, posteriors, log and status line: their content, and drawing only of changes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from syrupy.assertion import SnapshotAssertion
from textual.app import ComposeResult
from textual.geometry import Region
from textual.widget import Widget

from tangy_profiles.beliefs import Beta
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.panels import KeyLine
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.policy_table import PolicyRow, PolicyTable, bar
from tangy_tui.ui.widgets.posteriors import Posteriors, curve
from tangy_tui.ui.widgets.rows import fit, shorten, shorten_name
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.transcript import Transcript
from tangy_tui.ui.widgets.wrapping import wrap

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, Sample

SMALL = (80, 24)
LARGE = (160, 45)


STEP = "help · AR · wrong marks -> remove markers (User 2)"

ROWS = (
    PolicyRow("start · ANR · card not in view", "greeting", 1.0, 3),
    PolicyRow("help · AR · wrong marks", "remove markers", 0.98, 12),
    PolicyRow("help · AR · missed numbers", "mark numbers", 0.55, 4, "not sure"),
    PolicyRow("end · AR · card not in view", "valediction", 0.3, 0, "never shown"),
)


class One(TangyScreen[None]):
    """One widget that fills the screen."""

    def __init__(self, widget: Widget) -> None:
        super().__init__()
        self.widget = widget
        self.messages: list[Any] = []

    def compose(self) -> ComposeResult:
        yield self.widget

    def on_transcript_chosen(self, event: Transcript.Chosen) -> None:
        self.messages.append((event.number, event.text))

    def on_policy_table_chosen(self, event: PolicyTable.Chosen) -> None:
        self.messages.append((event.index, event.row))


def painted_by(widget: Widget) -> list[Region]:
    """Record a widget's requests for painting from now on."""
    noted: list[Region] = []
    refresh = widget.refresh

    def note(*regions: Region, **options: Any) -> Any:
        noted.extend(regions)
        return refresh(*regions, **options)

    widget.refresh = note  # type: ignore[method-assign]
    return noted


# ----------------------------------------------------------------------------------- steps


async def test_steps_are_numbered_lines_that_follow_the_end(run: Run) -> None:
    steps = Transcript()
    async with run(One(steps), (80, 18)) as pilot:
        for _ in range(30):
            steps.append(STEP)
        await pilot.pause()
        lines = pilot.lines()
        assert lines[-1] == f"30 {STEP}"
        assert lines[0] == f"13 {STEP}"
        steps.remove_last()
        await pilot.pause()
        assert pilot.lines()[-1] == f"29 {STEP}"
        assert steps.count == 29
        steps.append("facilitate · ANR · card not in view -> call number")
        await pilot.pause()
        assert pilot.lines()[-1].startswith("30 facilitate")


async def test_the_longest_steps_fit_into_one_line_of_80_columns(run: Run) -> None:
    steps = Transcript()
    async with run(One(steps)) as pilot:
        steps.append("facilitate · ANR · card not in view -> move card closer (User 2), suggestion")
        steps.append("help · AR · " + "very " * 30 + "-> " + "long " * 30)
        await pilot.pause()
        first, second = pilot.lines()[:2]
        assert first.endswith("-> move card closer (User 2), suggestion")
        assert second.startswith(" 2 help · AR")
        assert second.endswith("…")


async def test_the_list_of_steps_is_bounded_and_keeps_counting(run: Run) -> None:
    steps = Transcript(most=5)
    async with run(One(steps)) as pilot:
        for n in range(1, 13):
            steps.append(f"step {n}")
        await pilot.pause()
        lines = [line for line in pilot.lines() if line]
        assert lines == [f"{n:>2} step {n}" for n in range(8, 13)]


async def test_steps_can_be_browsed_by_keys(run: Run) -> None:
    steps = Transcript()
    screen = One(steps)
    async with run(screen, (80, 18)) as pilot:
        steps.focus()
        await pilot.press("up", "enter")  # without lines, keys do nothing
        for n in range(1, 41):
            steps.append(f"step {n}")
        await pilot.press("up")
        assert steps.chosen == 40
        await pilot.press("k", "up", "enter")
        await pilot.pause()
        assert screen.messages == [(38, "step 38")]
        await pilot.press("home")
        await pilot.pause()
        assert steps.chosen == 1
        assert pilot.lines()[0] == " 1 step 1"
        steps.append("step 41")
        await pilot.pause()
        assert pilot.lines()[0] == " 1 step 1"  # the view stays where a person has scrolled
        await pilot.press("end", "down")
        await pilot.pause()
        assert steps.chosen is None  # at the end it follows the newest again
        assert pilot.lines()[-1].startswith("41 step 41")


async def test_steps_can_be_filled_and_cleared(run: Run) -> None:
    steps = Transcript(empty="Nothing yet.")
    async with run(One(steps)) as pilot:
        assert "Nothing yet." in pilot.text()
        steps.fill(["one", "two"])
        await pilot.pause()
        assert pilot.lines()[:2] == [" 1 one", " 2 two"]
        steps.clear()
        await pilot.pause()
        assert "Nothing yet." in pilot.text()
        steps.remove_last()
        assert steps.count == 0


# ---------------------------------------------------------------------------------- policy


@pytest.mark.parametrize("size", [(60, 18), SMALL, LARGE])
async def test_the_policy_matches_its_snapshot(
    run: Run, snapshot: SnapshotAssertion, size: tuple[int, int]
) -> None:
    table = PolicyTable(classes="panel")
    async with run(One(table), size) as pilot:
        table.show(ROWS, "help · AR · wrong marks")
        await pilot.pause()
        assert pilot.text() == snapshot


async def test_a_policy_row_is_complete_at_every_width(run: Run) -> None:
    table = PolicyTable()
    async with run(One(table), LARGE) as pilot:
        table.show(ROWS)
        for width in (60, 70, 80, 100, 160):
            await pilot.resize_terminal(width, 24)
            await pilot.pause()
            text = pilot.text()
            for row in ROWS:
                assert row.situation in text
                assert row.behaviour in text
            assert ".55" in text
            assert "never shown" in text or "0 !" in text


async def test_only_rows_with_changed_marks_are_drawn(run: Run) -> None:
    table = PolicyTable()
    async with run(One(table)) as pilot:
        table.show(ROWS, ROWS[0].situation)
        await pilot.pause()
        painted = painted_by(table)
        table.highlight(ROWS[2].situation)
        assert sorted(r.y for r in painted) == [1, 3]
        assert all(r.height == 1 for r in painted)
        painted.clear()
        table.highlight(ROWS[2].situation)
        assert painted == []
        table.highlight("a situation that is not in the table")
        assert [r.y for r in painted] == [3]


async def test_policy_rows_can_be_chosen(run: Run) -> None:
    table = PolicyTable()
    screen = One(table)
    async with run(screen, (60, 18)) as pilot:
        table.focus()
        await pilot.press("enter", "down")
        table.show(ROWS)
        await pilot.press("down", "j", "enter")
        await pilot.pause()
        assert screen.messages == [(1, ROWS[1])]
        await pilot.press("end", "down", "enter")
        await pilot.pause()
        assert screen.messages[-1] == (3, ROWS[3])


def test_the_length_of_a_bar_is_its_share() -> None:
    assert bar(0, 5) == "     "
    assert bar(1, 5) == "█████"
    assert bar(0.5, 5) == "██▌  "
    assert bar(7, 3) == "███"


# ------------------------------------------------------------------------------ posteriors


@pytest.mark.parametrize("size", [(60, 18), SMALL, LARGE])
@pytest.mark.parametrize("compact", [False, True])
async def test_the_posteriors_match_their_snapshot(
    run: Run, sample: Sample, snapshot: SnapshotAssertion, size: tuple[int, int], compact: bool
) -> None:
    view = Posteriors(compact=compact, classes="panel")
    async with run(One(view), size) as pilot:
        view.show(sample.beliefs(), sample.names(), ("user1", "praise"))
        await pilot.pause()
        assert pilot.text() == snapshot


async def test_counts_mean_and_probability_match_the_posteriors(run: Run, sample: Sample) -> None:
    view = Posteriors()
    async with run(One(view)) as pilot:
        view.show({"user1": {"neutral": Beta(8, 3), "praise": Beta(1, 1)}}, {"user1": "Rosa"})
        await pilot.pause()
        line = next(line for line in pilot.lines() if "neutral" in line)
        assert "7/9" in line
        assert ".73" in line  # 8 / 11
        assert ".73★" in line  # the integral of x against Beta(8, 3) is its mean
        other = next(line for line in pilot.lines() if "praise" in line)
        assert "0/0" in other
        assert "★" not in other


async def test_equal_posteriors_have_no_star(run: Run) -> None:
    for compact in (False, True):
        view = Posteriors(compact=compact)
        async with run(One(view)) as pilot:
            view.show({"user1": {"neutral": Beta(8, 3), "praise": Beta(8, 3)}}, {})
            await pilot.pause()
            assert "★" not in pilot.text()


async def test_a_settled_strategy_is_shown_beside_the_name(run: Run) -> None:
    view = Posteriors()
    async with run(One(view)) as pilot:
        view.show({"u": {"neutral": Beta(2, 9), "praise": Beta(9, 2)}}, {"u": "Rosa"})
        await pilot.pause()
        assert "Rosa  settled: praise" in pilot.text()
        view.show({"u": {"neutral": Beta(2, 2), "praise": Beta(3, 2)}}, {"u": "Rosa"})
        await pilot.pause()
        assert "settled" not in pilot.text()


@pytest.mark.parametrize(
    "beliefs",
    [{"quiet": Beta(9, 2)}, {"neutral": Beta(1, 2), "praise": Beta(2, 60), "merry": Beta(2, 60)}],
)
async def test_a_single_or_unsuccessful_strategy_is_never_settled(
    run: Run, beliefs: dict[str, Beta]
) -> None:
    view = Posteriors()
    async with run(One(view)) as pilot:
        view.show({"u": beliefs}, {"u": "Rosa"})
        await pilot.pause()
        assert "settled" not in pilot.text()
        assert len(beliefs) > 1 or "★" not in pilot.text()


async def test_unknown_posteriors_have_no_best_strategy(run: Run) -> None:
    view = Posteriors()
    async with run(One(view)) as pilot:
        assert "Nothing is known" in pilot.text()
        view.show({"user1": {"neutral": Beta(), "praise": Beta()}}, {})
        await pilot.pause()
        assert "★" not in pilot.text()
        assert "user1" in pilot.text()


async def test_only_the_changed_posterior_is_drawn(run: Run, sample: Sample) -> None:
    view = Posteriors()
    async with run(One(view), LARGE) as pilot:
        beliefs = sample.beliefs()
        view.show(beliefs, sample.names())
        await pilot.pause()
        painted = painted_by(view)
        view.show(beliefs, sample.names())
        assert painted == []
        beliefs["user3"] = {**beliefs["user3"], "praise": beliefs["user3"]["praise"].updated(True)}
        view.show(beliefs, sample.names())
        assert {r.y for r in painted} <= {11, 12, 13, 14}  # the person's own lines


def test_a_curve_peaks_at_the_mode_of_the_posterior() -> None:
    flat = curve(Beta(1, 1), 12)
    assert len(set(flat)) == 1
    high = curve(Beta(40, 5), 12)
    assert high.index("█") >= 9
    assert curve(Beta(5, 40), 12) == high[::-1]
    assert len(curve(Beta(400, 400), 7)) == 7


# ------------------------------------------------------------------------- log, status line


async def test_the_log_wraps_marks_and_drops_lines(run: Run) -> None:
    log = LogView(most=3)
    async with run(One(log)) as pilot:
        for n in range(4):
            log.write(f"sentence {n}")
        log.write("The camera does not answer, " * 4, "bad")
        await pilot.pause()
        lines = [line for line in pilot.lines() if line.strip()]
        assert log.sentences[0] == "sentence 2"
        assert lines[2].startswith("✗ The camera")
        assert lines[3].startswith("  ")
        log.clear()
        await pilot.pause()
        assert not pilot.text().strip()


async def test_the_log_follows_its_end(run: Run) -> None:
    log = LogView()
    async with run(One(log), (60, 18)) as pilot:
        for n in range(50):
            log.write(f"sentence {n}")
        await pilot.pause()
        assert pilot.lines()[-1].startswith("  sentence 49")


@pytest.mark.parametrize("width", [60, 66, 80, 100, 160])
async def test_the_status_line_always_shows_robot_and_stop(run: Run, width: int) -> None:
    status = Status("teach", "link lost", "facilitate", 123, 4567, "Rosa's game", alarm=True)
    async with run(One(StatusLine(status)), (width, 18)) as pilot:
        line = pilot.lines()[0]
        assert "! robot link lost" in line
        assert line.endswith("^x STOP")
        assert "facilitate" in line


async def test_a_long_stage_is_cut_and_the_note_beside_it_stays(run: Run) -> None:
    stage = "a question about the seasons was asked, and nobody in the group has answered it yet"
    status = Status("live Trivia", "OK", stage, 3, 12, note="drives to Rosa")
    async with run(One(StatusLine(status)), (80, 18)) as pilot:
        line = pilot.text().splitlines()[0]
        assert stage[:20] in line and "drives to" in line and "game 3" not in line
    async with run(One(StatusLine(status)), (160, 18)) as pilot:
        line = pilot.text().splitlines()[0]
        assert stage in line and "game 3" in line and "drives to Rosa" in line


async def test_the_status_line_shows_mode_robot_game_and_step(run: Run) -> None:
    line = StatusLine(Status("teach", "OK", "help", 3, 12))
    async with run(One(line)) as pilot:
        assert pilot.lines()[0].split("  ")[0].strip() == (
            "TANGY teach │ robot OK │ help │ game 3 │ step 12"
        )
        painted = painted_by(line)
        line.show(Status("teach", "OK", "help", 3, 12))
        line.show(Status("teach", "OK", "help", 3, 13))
        await pilot.pause()
        assert "step 13" in pilot.text()
        assert painted == []  # the whole line, once


# ------------------------------------------------------------------------------------ text


def test_fit_shorten_and_wrap_count_cells() -> None:
    assert fit("abc", 5) == "abc  "
    assert fit("abcdef", 4) == "abc…"
    assert fit("ab cdef", 4) == "ab …"
    assert fit("x", 0) == ""
    assert shorten("abcdef", 4) == "abc…"
    assert shorten("abc", 4) == "abc"


@pytest.mark.parametrize(
    ("name", "width", "shown"),
    [
        ("User 12", 4, "U…12"),
        ("User 12", 7, "User 12"),
        ("User 12", 3, "Us…"),
        ("Rosalind", 5, "Rosa…"),
    ],
)
def test_a_name_that_is_cut_keeps_its_number(name: str, width: int, shown: str) -> None:
    assert shorten_name(name, width) == shown
    assert wrap("one two three", 7) == ["one two", "three"]
    assert wrap("abcdefghij", 4) == ["abcd", "efgh", "ij"]
    assert wrap("", 4) == [""]
    assert wrap("a call every 10\N{NO-BREAK SPACE}s", 15) == [
        "a call every",
        "10\N{NO-BREAK SPACE}s",
    ]


async def test_the_log_stays_at_its_end_after_shrinking(run: Run) -> None:
    log = LogView()
    screen = One(log)
    async with run() as pilot:
        await pilot.app.push_screen(screen)
        await pilot.pause()
        for number in range(60):
            log.write(f"sentence {number}")
        await pilot.pause()
        await pilot.resize_terminal(80, 18)  # as when a banner takes lines above it
        await pilot.pause()
        assert log.is_vertical_scroll_end
        log.write("the newest")
        await pilot.pause()
        assert log.is_vertical_scroll_end


async def test_a_scrolled_log_keeps_its_place_after_a_resize(run: Run) -> None:
    log = LogView()
    screen = One(log)
    async with run() as pilot:
        await pilot.app.push_screen(screen)
        await pilot.pause()
        for number in range(60):
            log.write(f"sentence {number}")
        await pilot.pause()
        log.scroll_to(y=5, animate=False)
        await pilot.pause()
        await pilot.resize_terminal(80, 18)
        log.write("the newest")
        await pilot.pause()
        assert log.scroll_offset.y == 5


# --------------------------------------------------------------------------------- key line


@pytest.mark.parametrize(("width", "shown"), [(68, False), (75, False), (85, True)])
async def test_the_keys_for_slower_and_faster_are_shown_together(
    run: Run, width: int, *, shown: bool
) -> None:
    keys = ("pause", "stop", "claim", "why", "slower", "faster", "autonomy", "back:leave", "help")
    async with run(One(KeyLine(*keys)), (width, 24)) as pilot:
        foot = pilot.lines()[0]
        assert ("slower" in foot, "faster" in foot) == (shown, shown)
