"""The report and the player in a real browser, from disk."""

from __future__ import annotations

import json
import os
import shutil
import time

import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs.report import build
from report_models import ALL, HOSTILE, saved

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
HANGS = 60


def needed(what):
    """Skip these tests, or fail where they must run."""
    message = f"{what} is missing (apt install chromium chromium-driver; pip install selenium)"
    if os.environ.get("FUZZYRS_BROWSER_TESTS") == "required":
        pytest.fail(message)
    pytest.skip(message)


@pytest.fixture(scope="module")
def browser():
    """A browser without a window. It is Debian's, with its own driver: nothing is downloaded."""
    program = next(filter(None, map(shutil.which, BROWSERS)), None) or needed("Chromium")
    driver = shutil.which("chromedriver") or needed("chromedriver")
    try:
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service
    except ImportError:
        needed("selenium")
    options = webdriver.ChromeOptions()
    options.binary_location = program
    for switch in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu"):
        options.add_argument(switch)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    chrome = webdriver.Chrome(options=options, service=Service(driver))
    yield chrome
    chrome.quit()


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    return build(saved(tmp_path_factory.mktemp("report")), experiments=ALL)


class Window:
    """A page in the browser."""

    def __init__(self, browser, path, *, width=1100, scheme="light"):
        self.browser, self.path = browser, path
        size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
        for log in ("browser", "performance"):
            browser.get_log(log)
        browser.get(path.as_uri())

    def run(self, script, *values):
        return self.browser.execute_script(script, *values)

    def all(self, selector):
        """The texts of elements."""
        script = "return [...document.querySelectorAll(arguments[0])].map((e) => e.textContent)"
        return self.run(script, selector)

    def complaints(self):
        return self.browser.get_log("browser")

    def requests(self):
        """Every address that the page asked for."""
        messages = [
            json.loads(entry["message"])["message"] for entry in self.browser.get_log("performance")
        ]
        sent = [m for m in messages if m["method"] == "Network.requestWillBeSent"]
        return {m["params"]["request"]["url"] for m in sent}

    def until(self, script, *values):
        """Wait for a condition, and return it."""
        end = time.monotonic() + HANGS
        while not (found := self.run(f"return {script}", *values)):
            assert time.monotonic() < end, f"never: {script}"
            time.sleep(0.02)
        return found


class Player:
    """The first player in a part of a page."""

    def __init__(self, window, within="body"):
        self.window, self.within = window, within
        # It is made when it comes near the window.
        window.run("document.querySelector(arguments[0]).scrollIntoView()", f"{within} .player")
        window.until("document.querySelector(arguments[0])", f"{within} .player canvas")

    def part(self, selector, script, *values):
        script = f"const part = document.querySelector(arguments[0]); {script}"
        return self.window.run(script, f"{self.within} .player {selector}", *values)

    def click(self, selector):
        self.part(selector, "part.click()")

    def picture(self):
        return self.part("canvas", "return part.toDataURL()")

    def time(self):
        return self.part("output", "return part.textContent")

    def set(self, selector, value, event):
        script = "part.value = arguments[1]; part.dispatchEvent(new Event(arguments[2]))"
        self.part(selector, script, value, event)

    def press(self, key, *, shift=False):
        about = "{key: arguments[1], shiftKey: arguments[2], bubbles: true}"
        self.part(
            "canvas", f"part.dispatchEvent(new KeyboardEvent('keydown', {about}))", key, shift
        )


@pytest.fixture
def window(browser, report):
    return Window(browser, report)


@pytest.fixture
def player(window):
    return Player(window, "#table-9-1")


def test_it_loads_from_disk_without_complaints_and_asks_for_nothing(window):
    window.run("document.querySelectorAll('.player').forEach((p) => p.scrollIntoView())")
    window.until("document.querySelector('.player canvas')")
    window.until("[...document.images].every((image) => image.complete)")
    assert window.complaints() == []
    assert {url for url in window.requests() if not url.startswith("data:")} == {
        window.path.as_uri()
    }
    assert window.run("return [...document.images].every((image) => image.naturalWidth > 0)")


def test_its_policy_keeps_others_from_speaking(window):
    window.run(
        "const [script, image] = ['script', 'img'].map((name) => document.createElement(name));"
        "script.textContent = 'document.title = `spoken`'; image.src = 'http://127.0.0.1:9/x.png';"
        "image.onerror = () => { window.refused = true; }; document.body.append(script, image)"
    )
    window.until("window.refused")
    assert window.run("return document.title") == "fuzzyrs: the thesis reproduced"
    refused = [entry["message"] for entry in window.complaints()]
    assert any("inline script" in message and "script-src" in message for message in refused)
    assert any("127.0.0.1" in message and "img-src" in message for message in refused)


def test_the_tables_and_the_counts_are_there(window):
    assert window.all("[id='table-9-1--1'] td")[:2] == ["5.2", "5.0 [3.0, 7.0]"]
    assert window.all("[id='table-9-1--2'] tr:last-child > *")[:3] == [
        "late",
        "1.00",
        "−4.00 [−6.00, –]",
    ]
    assert window.all("#overview > .counts > li") == ["✓ reproduced 1", "✗ differs 1"]
    assert window.all("#table-9-1 > .counts > li") == ["✓ reproduced 1", "✗ differs 1"]
    assert len(window.all("#claims tbody > tr")) == 26
    assert window.all("#table-9-1 .command code") == [
        "fuzzyrs reproduce table-9-1 --seeds 5 --seed 3"
    ]


def test_a_game_rests_at_its_end_and_plays_from_its_start(window, player):
    # The one that goes straight never captures.
    assert player.time() == "20.0 / 20.0 s"
    at_rest = player.picture()
    player.click(".player-play")
    window.until("parseFloat(document.querySelector('#table-9-1 output').textContent) < 10")
    begun, picture = player.time(), player.picture()
    assert picture != at_rest
    window.until("document.querySelector('#table-9-1 output').textContent !== arguments[0]", begun)
    assert player.picture() != picture
    assert player.part(".player-play", "return part.ariaLabel") == "pause"
    assert window.complaints() == []


def test_a_pause_stops_it_and_nothing_runs_then(window, player):
    player.click(".player-play")
    window.until("parseFloat(document.querySelector('#table-9-1 output').textContent) < 10")
    player.click(".player-play")
    stopped = player.time(), player.picture()
    window.run(
        "window.asked = 0; const ask = window.requestAnimationFrame;"
        "window.requestAnimationFrame = (f) => { window.asked += 1; return ask(f); }"
    )
    # Three frames of the browser later.
    window.run(
        "window.later = 0; const wait = () => ++window.later < 3 && setTimeout(wait, 50); wait()"
    )
    window.until("window.later >= 3")
    assert (player.time(), player.picture()) == stopped
    assert window.run("return window.asked") == 0


def test_it_goes_to_the_time_that_is_asked_for(player):
    player.set("input[type=range]", 3.25, "input")
    assert player.time() == "3.3 / 20.0 s"
    assert player.part("input[type=range]", "return part.ariaValueText") == "3.3 of 20.0 seconds"
    player.press("Home")
    assert player.time() == "0.0 / 20.0 s"
    player.press("ArrowRight")
    player.press("ArrowRight", shift=True)
    assert player.time() == "1.1 / 20.0 s"
    player.press("ArrowLeft")
    assert player.time() == "1.0 / 20.0 s"
    player.press("End")
    assert player.time() == "20.0 / 20.0 s"
    player.press(" ")
    assert player.part(".player-play", "return part.ariaLabel") == "pause"


def test_it_plays_as_fast_as_it_is_told(window, player):
    player.set(".player-bar select", "0.5", "change")
    window.run("window.began = performance.now()")
    player.click(".player-play")
    window.until("parseFloat(document.querySelector('#table-9-1 output').textContent) > 0.3")
    shown = float(player.time().split()[0])
    # What is shown may lag behind, but not run ahead.
    assert shown <= 0.5 * window.run("return (performance.now() - window.began) / 1000") + 0.05
    player.set(".player-bar select", "8", "change")
    window.until("document.querySelector('#table-9-1 .player-play').ariaLabel === 'play'")
    assert player.time() == "20.0 / 20.0 s"


def test_games_can_be_hidden_and_another_be_chosen(window, player):
    legend = window.all("#table-9-1 .player-game")
    assert legend == ["classical: captured at 4.5 s", "straight: escaped for 20.0 s"]
    both = player.picture()
    player.click(".player-game input")
    assert player.picture() != both
    player.click(".player-game input")
    assert player.picture() == both
    assert window.all("#table-9-1 .player option")[:2] == [
        "evader from (2, 4) m",
        "evader from (-6, 7) m",
    ]
    player.set(".player-choice select", "1", "change")
    assert player.picture() != both
    assert window.all("#table-9-1 .player-game")[0] == "classical: captured at 9.6 s"


def test_a_close_up_follows_the_robots(player):
    # The one that goes straight ends far away from its evader.
    player.click(".player-game:last-child input")
    whole = player.picture()
    player.click(".player-close-up input")
    assert player.picture() != whole
    player.press("Home")
    first = player.picture()
    # The robots are elsewhere then, and the axes with them.
    player.press("ArrowRight", shift=True)
    assert player.picture() != first
    player.press("End")
    player.click(".player-close-up input")
    assert player.picture() == whole


LUMINANCE = """
const [r, g, b] = getComputedStyle(document.body).backgroundColor.match(/[\\d.]+/g).map(Number);
return (r + g + b) / 765;
"""


def test_dark_is_as_the_system_has_it_or_as_the_button_says(browser, report):
    dark = Window(browser, report, scheme="dark")
    player = Player(dark, "#table-9-1")
    assert dark.run(LUMINANCE) < 0.2
    picture = player.picture()
    dark.run("document.querySelector('.theme-switch').click()")
    assert dark.run(LUMINANCE) > 0.8
    # The canvas follows.
    dark.until("document.querySelector('#table-9-1 canvas').toDataURL() !== arguments[0]", picture)
    light = Window(browser, report, scheme="light")
    assert light.run(LUMINANCE) > 0.8
    assert light.all(".theme-switch") == ["dark"]


def test_a_phone_needs_no_scrolling_sideways(browser, report):
    phone = Window(browser, report, width=360)
    Player(phone, "#table-9-1")
    Player(phone, "#figure-9-3")
    assert phone.run("return document.documentElement.scrollWidth") == 360
    # Nothing but a table in its box reaches beyond the window.
    beyond = phone.run(
        "return [...document.querySelectorAll('body *')].filter((node) => !node.closest("
        "'.scrolled, .skip, pre, .command code, svg') && node.getBoundingClientRect().right > 361)"
        ".map((node) => node.outerHTML.slice(0, 80))"
    )
    assert beyond == []
    table = phone.run(
        "const box = document.querySelector('#table-9-1 .scrolled');"
        "return [box.clientWidth, getComputedStyle(box).overflowX]"
    )
    assert table == [328, "auto"]


def test_hostile_texts_are_texts(window):
    player = Player(window, "#figure-9-3")
    assert window.run("return document.title") == "fuzzyrs: the thesis reproduced"
    assert window.run("return document.querySelectorAll('img[src=x]').length") == 0
    assert window.all("#figure-9-3 .title") == [HOSTILE]
    assert window.all("#figure-9-3 .row-name") == [HOSTILE]
    assert window.all("#figure-9-3 .reason") == [HOSTILE]
    assert window.all("#figure-9-3 .player-choice option") == [HOSTILE, "other"]
    assert window.all("#figure-9-3 .player-game") == [f"{HOSTILE}: escaped for 0.1 s"]
    assert f"pursuer {HOSTILE}" in window.all("#figure-9-3 .player-names > span")
    assert HOSTILE in player.part("canvas", "return part.ariaLabel")
    assert window.complaints() == []


def animated(browser, tmp_path, *robots, **more):
    """The page of a game whose robots take these poses."""
    roles = ("pursuer", "evader")
    robots = tuple(
        fz.RecordedRobot(role, role, np.asarray(poses, dtype=float))
        for role, poses in zip(roles, robots, strict=False)
    )
    game = fz.Recording(robots, **{"time_step": 0.1, **more})
    return Window(browser, fz.animate(game, tmp_path / "game.html"))


def test_a_game_without_steps_is_shown(browser, tmp_path):
    window = animated(browser, tmp_path, [(1, 2, 0)], time_step=0.0)
    player = Player(window)
    player.click(".player-play")
    window.until("document.querySelector('.player-play').ariaLabel === 'play'")
    assert player.time() == "0.0 / 0.0 s"
    assert window.complaints() == []


def test_a_long_game_far_away_whose_robots_end_apart_is_shown(browser, tmp_path):
    angle = np.linspace(0, 300, 60_001)
    spiral = np.column_stack([1e7 + angle * np.cos(angle), -1e7 + angle * np.sin(angle), angle])
    window = animated(browser, tmp_path, spiral, spiral[:5], capture_time=6000.0, capture_radius=5)
    player = Player(window)
    assert player.time() == "6000.0 / 6000.0 s"
    # 512 times as fast as it was played.
    assert player.part(".player-bar select", "return part.value") == "512"
    picture = player.picture()
    player.set("input[type=range]", 100, "input")
    assert player.picture() != picture
    player.click(".player-play")
    window.until("parseFloat(document.querySelector('output').textContent) > 200")
    assert window.complaints() == []
