"""The chest screen in a real browser: texts, sizes, and a lost link."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from pathlib import Path

import cv2
import pytest

from tangy_hw.device_protocols import Picture
from tangy_hw.drivers import chest
from tangy_hw.drivers.chest import WebChestScreen
from tangy_hw.drivers.chest_pairing import keep_pairing
from tests.hw.waiting import until
from tests.real.browser import CHROMIUM, Browser, Tab, chromium
from tests.support.media import make_picture
from tests.support.terminal import PATIENCE

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed: no browser to look"),
    pytest.mark.xdist_group("chromium"),
]

UNPAIRED = "((document.body || {}).className || '').indexOf('unpaired') >= 0"
CALL = Picture("Next number", "B-12", ("N-40", "O-75", "I-17", "G-52", "B-3"))
SMALL, LARGE = (800, 480), (1280, 800)
LETTER = 0.35
"""The least height of a digit as a share of the window's: 32 mm on a tablet of seven inches, which
is 28 minutes of arc at four metres; a good eye needs five."""


@pytest.fixture(autouse=True)
def patience(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give the browser more time, because it shares its processor with other tests."""
    monkeypatch.setattr(chest, "SHOW_SECONDS", PATIENCE)


@pytest.fixture
async def screen() -> AsyncIterator[WebChestScreen]:
    made = WebChestScreen(port=0)
    await made.start()
    yield made
    await made.close()


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with chromium(tmp_path_factory.mktemp("profile")) as running:
        yield running


@pytest.fixture
async def browser(address: str) -> AsyncIterator[Browser]:
    made = Browser(address)
    yield made
    await made.close()


async def opened(browser: Browser, screen: WebChestScreen, size: tuple[int, int]) -> Tab:
    """Open the page, pair the tablet if necessary, and wait until it has answered."""
    tab, pages = await browser.tab(), screen.pages
    await tab.open(screen.url, *size)
    while screen.pages == pages:
        if await tab.value(UNPAIRED):
            await enter(tab, screen.code)
            break
        await asyncio.sleep(0.05)
    await until(lambda: screen.pages > pages, PATIENCE)
    return tab


async def enter(tab: Tab, code: str) -> None:
    """Type a code as a person does, and confirm it."""
    await tab.until("document.activeElement.id === 'code'")
    await tab.ask("Input.insertText", text=code)
    for kind in ("keyDown", "keyUp"):
        await tab.ask(
            "Input.dispatchKeyEvent", type=kind, key="Enter", code="Enter", text="\r",
            windowsVirtualKeyCode=13,
        )  # fmt: skip


async def read(tab: Tab, element: str) -> str:
    """Return the visible text of an element."""
    return str(await tab.value(f"document.getElementById('{element}').innerText")).strip()


async def outside(tab: Tab) -> str:
    """Name an element beyond the window, or beyond its box; "" if all are within."""
    return str(
        await tab.value(
            """(function () {
              var all = "#asked, #letter, #number, #text span, #before span";
              var shown = document.querySelectorAll(all);
              var main = document.getElementById("main").getBoundingClientRect();
              for (var i = 0; i < shown.length; i += 1) {
                var box = shown[i].getBoundingClientRect();
                if (!box.width) { continue; }
                var seen = box.left >= 0 && box.right <= window.innerWidth + 1 &&
                           box.top >= 0 && box.bottom <= window.innerHeight + 1;
                if (document.getElementById("main").contains(shown[i])) {
                  seen = seen && box.top >= main.top - 1 && box.bottom <= main.bottom + 1;
                }
                if (!seen) { return shown[i].id + ": " + shown[i].textContent; }
              }
              return "";
            }())"""
        )
    )


async def test_a_called_number_is_large_and_black_on_white(
    screen: WebChestScreen, browser: Browser, tmp_path: Path
) -> None:
    for size in (SMALL, LARGE):
        tab = await opened(browser, screen, size)
        await screen.show(CALL)
        assert (await read(tab, "letter"), await read(tab, "number")) == ("B", "12")
        assert await read(tab, "text") == "Next number"
        chips = "Array.from(document.querySelectorAll('#before span'), c => c.textContent)"
        assert await tab.value(chips) == [one.replace("-", "") for one in CALL.before]
        assert await outside(tab) == ""
        # Digits as drawn: the rows of the right half that have ink in them.
        picture = tmp_path / f"{size[0]}.png"
        await tab.screenshot(picture)
        seen = cv2.imread(str(picture), cv2.IMREAD_GRAYSCALE)
        assert seen is not None and seen.shape == size[::-1]
        digits = seen[: round(size[1] * 0.66), size[0] // 2 :]
        inked = (digits < 60).any(axis=1)
        assert inked.sum() / size[1] >= LETTER
        assert digits.min() < 30 and digits.max() > 245


@pytest.mark.parametrize("size", [SMALL, LARGE, (480, 800)])
async def test_every_text_fits_on_the_screen(
    screen: WebChestScreen, browser: Browser, size: tuple[int, int]
) -> None:
    tab = await opened(browser, screen, size)
    for picture in (
        Picture("Please mark: B-7, N-40, O-75", asks="Annemarie"),
        Picture("BINGO! Annemarie wins!"),
        Picture("on and on " * 30, before=CALL.before),
        Picture(
            "Donaudampfschifffahrtsgesellschaftskapitän", asks="Wilhelmina van der Meer-Schmidt"
        ),
        CALL._replace(asks="Ana", text="Is it on your card? Please look again, there is time."),
        Picture("", "O-75"),
    ):
        await screen.show(picture)
        assert await outside(tab) == "", picture
        assert (await read(tab, "text")).split() == picture.text.split()
        assert await read(tab, "asked") == picture.asks


@pytest.mark.parametrize("size", [SMALL, LARGE, (480, 800)])
async def test_each_option_of_a_question_has_its_own_line(
    screen: WebChestScreen, browser: Browser, size: tuple[int, int]
) -> None:
    tab = await opened(browser, screen, size)
    lines = ["Which one has black and white keys?", "A the violin", "B the piano", "C the horn"]
    await screen.show(Picture("  ".join(lines), asks="Reds"))
    assert await outside(tab) == ""
    found = await tab.value(
        """(function () {
          var spans = document.querySelectorAll("#text span"), lines = {}, i, top;
          for (i = 0; i < spans.length; i += 1) {
            top = Math.round(spans[i].getBoundingClientRect().top);
            lines[top] = (lines[top] ? lines[top] + " " : "") + spans[i].textContent;
          }
          return Object.keys(lines).sort(function (a, b) { return a - b; }).map(
            function (top) { return lines[top]; });
        }())"""
    )
    assert found[-3:] == lines[1:]
    assert " ".join(found[:-3]) == lines[0]


@pytest.mark.parametrize("size", [SMALL, LARGE, (480, 800)])
@pytest.mark.parametrize("shape", [(300, 900), (900, 300)])
async def test_a_picture_is_large_with_its_caption_below(
    screen: WebChestScreen,
    browser: Browser,
    tmp_path: Path,
    size: tuple[int, int],
    shape: tuple[int, int],
) -> None:
    tab = await opened(browser, screen, size)
    file = make_picture(tmp_path / "photo.png", *shape)
    for text, asks in (
        ("", ""),
        ("Who remembers a steam train?", "Seat 2"),
        ("on and on " * 12, ""),
    ):
        await screen.show(Picture(text, asks=asks, file=str(file)))
        assert await outside(tab) == ""
        assert (await read(tab, "text")).split() == text.split()
        shot = tmp_path / "seen.png"
        await tab.screenshot(shot)
        seen = cv2.imread(str(shot))
        assert seen is not None
        red = (seen[..., 2] > 180) & (seen[..., 0] < 60) & (seen[..., 1] < 60)
        high, wide = (red.any(axis=1 - axis).sum() for axis in (0, 1))
        assert wide / high == pytest.approx(shape[1] / shape[0], rel=0.03)
        assert max(wide / size[0], high / size[1]) > 0.45
        assert red.sum() == pytest.approx(wide * high, rel=0.01)  # nothing covers it
    await screen.show(Picture("Next question"))
    assert await tab.value("document.getElementById('file').offsetHeight") == 0


async def test_a_broken_picture_leaves_its_caption(
    screen: WebChestScreen, browser: Browser, tmp_path: Path
) -> None:
    tab = await opened(browser, screen, LARGE)
    broken = tmp_path / "broken.png"
    broken.write_bytes(b"\x89PNG\r\n\x1a\n and no more")
    for file in (tmp_path / "none.png", broken):
        await screen.show(Picture("Who remembers a steam train?", file=str(file)))
        assert await read(tab, "text") == "Who remembers a steam train?"
        assert await tab.value("document.getElementById('file').offsetHeight") == 0


async def test_markup_in_a_text_is_shown_as_text(screen: WebChestScreen, browser: Browser) -> None:
    tab = await opened(browser, screen, LARGE)
    wicked = "<img src=x onerror=document.title='got-you'>&amp;</script>\u2028`${1}"
    await screen.show(Picture(wicked, wicked, (wicked,), wicked))
    assert await tab.value("document.getElementById('number').textContent") == wicked
    assert await tab.value("document.getElementById('asked').textContent") == wicked
    assert await tab.value("document.images.length + document.scripts.length") == 2  # its own
    assert await tab.value("document.title") == "Chest screen"


async def test_the_page_reports_a_lost_link_and_reconnects(browser: Browser) -> None:
    screen = WebChestScreen(port=0)
    await screen.start()
    tab = await opened(browser, screen, SMALL)
    await screen.show(CALL)
    assert await tab.value("document.getElementById('lost').offsetHeight") == 0
    port = screen.port
    await screen.close()
    await tab.until("document.getElementById('lost').offsetHeight > 40")
    assert (await read(tab, "lost")).startswith("No link to the robot")
    assert await read(tab, "number") == "12"  # the called number stays, pale
    again = WebChestScreen(port=port, pairing=screen.pairing)
    await again.start()
    await until(lambda: again.pages == 1, PATIENCE)
    await again.show(Picture("", "O-75"))
    await tab.until("document.getElementById('lost').offsetHeight === 0")
    assert await read(tab, "number") == "75"
    await again.close()


async def test_a_hanging_tablet_is_noticed(screen: WebChestScreen, browser: Browser) -> None:
    tab = await opened(browser, screen, SMALL)
    await until(lambda: screen.reading().state == "OK", PATIENCE)
    hanging = asyncio.ensure_future(
        tab.value("(function () { var end = Date.now() + 2500; while (Date.now() < end) {} }())")
    )
    await until(lambda: screen.reading().state == "STALE", PATIENCE)
    await hanging
    await until(lambda: screen.reading().state == "OK", PATIENCE)


async def test_a_tablet_stays_paired(browser: Browser, tmp_path: Path) -> None:
    pairing = keep_pairing(tmp_path)
    screen = WebChestScreen(port=0, pairing=pairing)
    await screen.start()
    await screen.show(CALL)
    tab = await browser.tab()
    await tab.open(screen.url, *SMALL)
    await tab.until(UNPAIRED)
    assert await read(tab, "number") == "" and screen.reading().state == "WARN"
    wrong = "00000000" if pairing.code != "00000000" else "11111111"
    await enter(tab, wrong)
    await tab.until("document.getElementById('wrong').innerText.indexOf('not the code') > 0")
    assert screen.reading().state == "WARN"
    await enter(tab, screen.code)
    await until(lambda: screen.reading().state == "OK", PATIENCE)
    await tab.until("document.getElementById('number').innerText === '12'")
    assert not await tab.value(UNPAIRED)
    assert not await tab.value("document.cookie")  # no script of the page can read the token
    # The robot process ends, and another one begins: nobody has to enter a code again.
    port = screen.port
    await screen.close()
    await tab.until("document.getElementById('lost').offsetHeight > 40")
    assert not await tab.value(UNPAIRED)
    again = WebChestScreen(port=port, pairing=keep_pairing(tmp_path))
    await again.start()
    await again.show(Picture("", "O-75"))
    await until(lambda: again.reading().state == "OK", PATIENCE)
    await tab.until("document.getElementById('number').innerText === '75'")
    before = set(again.windows)
    await tab.ask("Page.reload")
    await until(lambda: bool(set(again.windows) - before) and again.why == "", PATIENCE)
    await again.close()


async def test_an_unknown_tablet_asks_for_the_code(browser: Browser) -> None:
    screen = WebChestScreen(port=0)
    await screen.start()
    tab = await opened(browser, screen, SMALL)
    await screen.show(CALL)
    await screen.close()
    other = WebChestScreen(port=screen.port)
    await other.start()
    await tab.until(UNPAIRED)
    assert other.reading().state == "WARN"
    hidden = "document.getElementById('number').offsetHeight === 0"
    assert await tab.value(hidden)  # earlier calls are hidden
    await enter(tab, other.code)
    await until(lambda: other.reading().state == "OK", PATIENCE)
    await tab.until("document.body.className.indexOf('unpaired') < 0")
    await other.close()


@pytest.mark.parametrize("size", [SMALL, LARGE, (480, 800)])
async def test_the_question_for_the_code_fits_on_the_screen(
    screen: WebChestScreen, browser: Browser, size: tuple[int, int]
) -> None:
    tab = await browser.tab()
    await tab.open(screen.url, *size)
    await tab.until(UNPAIRED)
    await enter(tab, "123")
    await tab.until("document.getElementById('wrong').innerText")
    assert await tab.value("document.getElementById('main').offsetHeight") == 0
    for element in ("code", "wrong", "pair"):
        box = f"document.getElementById('{element}').getBoundingClientRect()"
        assert await tab.value(f"{box}.bottom <= innerHeight && {box}.right <= innerWidth")
    high = "document.getElementById('code').getBoundingClientRect().height"
    assert await tab.value(high) >= 44  # large enough for a finger


async def test_a_press_on_a_call_button_is_acknowledged(
    browser: Browser, screen: WebChestScreen
) -> None:
    await screen.show(CALL)
    tab = await opened(browser, screen, SMALL)
    screen.offer({"staff 1": "Station 2", "expert 1": "Anna Berg"})
    await tab.until("document.querySelectorAll('#calls button').length === 2")
    words = await tab.value("document.querySelector('#calls button').textContent")
    assert words == "Station 2: I am coming"
    high = await tab.value("document.querySelector('#calls button').offsetHeight")
    assert high >= 44  # CSS pixels: large enough for a finger
    inside = "document.getElementById('calls').getBoundingClientRect().bottom <= innerHeight + 1"
    assert await tab.value(inside)
    assert not await tab.value("document.body.scrollHeight > innerHeight + 1")
    await tab.value("document.querySelector('#calls button').click()")
    await until(lambda: screen.answered == ("staff 1",), PATIENCE)
    await tab.until("document.getElementById('calls').textContent.indexOf('Thank you') >= 0")
    assert await tab.value("document.querySelectorAll('#calls button').length") == 1
    screen.offer({})
    await tab.until("document.querySelectorAll('#calls button').length === 0")
