"""The compliance report as a reader meets it: in a browser at three widths, in light and dark, on paper, by keyboard.

Needs FIELDPROOF (the program) and a Chromium. The screenshots are left in SCREENSHOTS (target/screenshots), to be looked at.
"""

from __future__ import annotations

import functools
import pathlib
import shutil
import subprocess
import unittest

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, sync_playwright
from pypdf import PdfReader

from runs import FIELDPROOF, SCREENSHOTS, Runs

WIDTHS = (390, 820, 1440)
# Colours and widths have nothing to do with each other.
SCHEMES = {390: ("dark",), 820: ("light",), 1440: ("light",)}
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
SLOWEST_MS = 1000
LARGEST_BYTES = 5_000_000
# Width and height of A4 in points, and how far a printer driver may round.
A4 = (595, 842)


def setUpModule() -> None:
    SCREENSHOTS.mkdir(parents=True, exist_ok=True)


def tearDownModule() -> None:
    Runs.remove()


class Reader(unittest.TestCase):
    """A browser that nothing escapes."""

    @classmethod
    def setUpClass(cls) -> None:
        found = [path for path in map(shutil.which, BROWSERS) if path]
        assert found, f"none of {', '.join(BROWSERS)} is installed"
        cls.playwright = sync_playwright().start()
        cls.browser = cls.playwright.chromium.launch(executable_path=found[0], args=["--no-sandbox"])
        cls.addClassCleanup(cls.playwright.stop)
        cls.addClassCleanup(cls.browser.close)

    def open(self, page_file: pathlib.Path, width: int = 1440, scheme: str = "light", **more: object) -> Page:
        """The page, once its list of cases is there. Whatever goes wrong in it fails the test."""
        page = self.browser.new_page(viewport={"width": width, "height": 1000}, color_scheme=scheme, **more)
        self.addCleanup(page.close)
        troubles: list[str] = []
        page.on("console", lambda message: troubles.append(message.text) if message.type in ("error", "warning") else None)
        page.on("pageerror", lambda error: troubles.append(str(error)))
        page.on("request", lambda request: troubles.append(request.url) if request.url != page_file.as_uri() and not request.url.startswith(("blob:", "data:")) else None)
        self.addCleanup(lambda: self.assertEqual(troubles, []))
        page.goto(page_file.as_uri())
        if "java_script_enabled" not in more and page.locator("#list").count():
            page.wait_for_selector("#list[aria-busy=false]")
        return page

    def serious(self, page: Page) -> list[str]:
        found = Axe().run(page).response["violations"]
        return [
            f"{it['id']}: {it['help']}: {it['nodes'][0]['html'][:200]}"
            for it in found
            if it["impact"] in ("serious", "critical")
        ]


class Looks(Reader):
    """What can be seen."""

    def look(self, name: str, report: pathlib.Path) -> None:
        for width in WIDTHS:
            for scheme in SCHEMES[width]:
                with self.subTest(name, width=width, scheme=scheme):
                    page = self.open(report, width, scheme)
                    inside = "document.documentElement.scrollWidth <= document.documentElement.clientWidth"
                    self.assertTrue(page.evaluate(inside), "the page is wider than the window")
                    page.screenshot(path=SCREENSHOTS / f"{name}-{width}-{scheme}.png")
                    if page.locator("#list").count():
                        # Cases are unpacked when one comes near them; skipped ones have nothing to show.
                        page.locator("[name=verdict][value='1']").uncheck()
                        page.locator("#cases h2").scroll_into_view_if_needed()
                        page.wait_for_selector(".case:not(.skipped)")
                        page.locator(".case:not(.skipped) > summary").first.click()
                        page.wait_for_selector(".case[open] .detail p")
                        page.screenshot(path=SCREENSHOTS / f"{name}-{width}-{scheme}-case.png")
                        self.assertTrue(page.evaluate(inside), "an open case is wider than the window")
                    self.assertEqual(self.serious(page), [])

    def test_run_that_passes(self) -> None:
        self.look("passing", Runs.passing() / "report.html")

    def test_run_that_fails(self) -> None:
        self.look("failing", Runs.failing() / "report.html")

    def test_run_that_was_killed(self) -> None:
        self.look("killed", Runs.killed() / "report.html")
        page = self.open(Runs.killed() / "report.html")
        self.assertIn("This run is incomplete", page.locator("[role=alert]").inner_text())
        self.assertEqual(page.locator(".verdict .word").inner_text(), "Incomplete")

    def test_comparison(self) -> None:
        old, new = Runs.passing(), Runs.failing()
        page = Runs.folder / "comparison.html"
        ran = subprocess.run([FIELDPROOF, "compare", old, new, "--format", "html"], capture_output=True, check=False)
        self.assertEqual(ran.returncode, 1)
        page.write_bytes(ran.stdout)
        self.look("comparison", page)

    def test_head_says_what_was_found_on_what(self) -> None:
        page = self.open(Runs.passing() / "report.html")
        self.assertEqual(page.locator("h1").inner_text(), "Kinco servo drive")
        self.assertEqual(page.locator(".verdict .word").inner_text(), "Passed")
        head = page.locator(".columns").inner_text()
        for words in ("A. Smith", "PO-2231 <b>&", "order number", "serial number", "vendor id", "1018h:01", "500 kbit/s", "instants"):
            self.assertIn(words, head)
        self.assertGreater(page.locator(".coverage tbody tr").count(), 20)
        self.assertGreater(page.locator("figure svg").count(), 2)
        hashes = page.locator("#run .hash").all_inner_texts()
        self.assertTrue(len(hashes) > 10 and all(len(it) == 64 for it in hashes))

    def test_failure_marks_the_bytes_that_differ(self) -> None:
        page = self.open(Runs.failing() / "report.html")
        finding = page.locator(".finding.fail").filter(has_text="unknown-object").first
        marks = finding.locator(".compare mark").all_inner_texts()
        self.assertEqual(len(marks), 2)
        self.assertNotEqual(marks[0], marks[1])
        self.assertEqual(finding.locator("tr.marked").count(), 1)


class Use(Reader):
    """What can be done with it."""

    def test_filters(self) -> None:
        page = self.open(Runs.passing() / "report.html")
        cases = Runs.events(Runs.passing(), "case-finished")
        count = lambda verdict: sum(case["verdict"] == verdict for case in cases)
        shown = lambda: page.locator("#shown").inner_text()
        self.assertEqual(shown(), f"all {len(cases):,} shown")
        page.locator("[name=verdict][value='1']").uncheck()
        page.wait_for_function(f"document.querySelector('#shown').textContent.startsWith('{len(cases) - count('skipped'):,} of')")
        page.locator("[name=verdict][value='0']").uncheck()
        page.wait_for_function(f"document.querySelector('#shown').textContent.startsWith('{count('deviation')} of')")
        self.assertEqual(page.locator(".case").count(), count("deviation"))
        self.assertEqual(page.locator(".case:not(.deviation)").count(), 0)
        page.keyboard.press("Escape")
        page.locator("#text").fill("toggle-bit")
        wanted = [case for case in cases if "toggle-bit" in case["id"]]
        page.wait_for_function("!document.querySelector('#shown').textContent.startsWith('all')")
        names = page.locator(".suite:not([hidden]) .case code").all_inner_texts()
        self.assertTrue(len(names) >= len(wanted) > 0)
        page.locator("#text").fill("nothing is called like this")
        page.wait_for_function("document.querySelector('#shown').textContent.startsWith('0 of')")

    def test_device_is_chosen(self) -> None:
        page = self.open(Runs.everything() / "report.html")
        page.locator("#device").select_option(label="teco-inverter")
        page.wait_for_function("document.querySelectorAll('.suite:not([hidden])').length > 0 && !document.querySelector('#shown').textContent.startsWith('all')")
        devices = set(page.locator(".suite:not([hidden]) h3").all_inner_texts())
        self.assertTrue(all("on teco-inverter" in it for it in devices), devices)

    def test_case_opens_with_its_exchange(self) -> None:
        page = self.open(Runs.failing() / "report.html")
        page.locator(".finding.fail h4 a").first.click()
        page.wait_for_selector(".case[open] .frames tbody tr")
        detail = page.locator(".case[open] .detail")
        text = detail.inner_text()
        for words in ("follows", "CiA 301", "written in", "SDO", "what was changed is put back"):
            self.assertIn(words, text)
        self.assertRegex(text, r"(step|control) 1, line \d+")
        self.assertEqual(detail.locator("tr.marked").count(), 1)
        self.assertEqual(detail.locator("mark").count(), 2)

    def test_keyboard(self) -> None:
        page = self.open(Runs.passing() / "report.html")
        page.keyboard.press("/")
        self.assertEqual(page.evaluate("document.activeElement.id"), "text")
        page.keyboard.type("sdo")
        page.wait_for_function("!document.querySelector('#shown').textContent.startsWith('all')")
        page.keyboard.press("Escape")
        page.evaluate("document.activeElement.blur()")
        page.keyboard.press("n")
        page.wait_for_selector(".case.deviation[open] .detail p")
        self.assertEqual(page.evaluate("document.activeElement.tagName"), "SUMMARY")
        first = page.evaluate("document.activeElement.parentElement.id")
        page.keyboard.press("n")
        page.wait_for_function(f"document.activeElement.parentElement.id !== '{first}'")

    def test_reader_chooses_the_colours(self) -> None:
        page = self.open(Runs.passing() / "report.html", scheme="light")
        colour = functools.partial(page.evaluate, "getComputedStyle(document.body).backgroundColor")
        before = colour()
        page.locator("#theme").click()
        self.assertNotEqual(colour(), before)
        page.reload()
        page.wait_for_selector("#list[aria-busy=false]")
        self.assertNotEqual(colour(), before)

    def test_without_scripts_all_but_the_list_is_there(self) -> None:
        page = self.open(Runs.failing() / "report.html", java_script_enabled=False)
        self.assertTrue(page.locator("noscript").is_visible() or "report.json" in page.content())
        self.assertGreater(page.locator(".finding.fail").count(), 0)
        self.assertGreater(page.locator(".coverage tbody tr").count(), 5)

    def test_default_run_is_small_and_quick(self) -> None:
        report = Runs.everything() / "report.html"
        self.assertLess(report.stat().st_size, LARGEST_BYTES)
        # The best of three, for the machine may be doing something else.
        times = []
        for _ in range(3):
            page = self.open(report)
            times.append(page.evaluate("performance.getEntriesByName('ready')[0].startTime"))
            page.close()
        print(f"{report.stat().st_size / 1e6:.1f} MB, interactive after {min(times):.0f} ms")
        self.assertLess(min(times), SLOWEST_MS)

    def test_filtering_every_case_takes_no_time(self) -> None:
        page = self.open(Runs.everything() / "report.html")
        page.locator("#text").fill("heartbeat")
        page.wait_for_function("!document.querySelector('#shown').textContent.startsWith('all')")
        script = "() => { const box = document.querySelector('#text'); box.value = 'sdo'; const start = performance.now(); box.dispatchEvent(new Event('input', {bubbles: true})); return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(performance.now() - start)))); }"
        self.assertLess(min(page.evaluate(script) for _ in range(3)), 250)


class Paper(Reader):
    """What is printed."""

    def pages(self, report: pathlib.Path, name: str) -> list[str]:
        page = self.open(report)
        page.emulate_media(media="print", color_scheme="dark")
        printed = SCREENSHOTS / f"{name}.pdf"
        page.pdf(path=printed, prefer_css_page_size=True, print_background=True)
        pdf = PdfReader(printed)
        for sheet in pdf.pages:
            size = (float(sheet.mediabox.width), float(sheet.mediabox.height))
            self.assertTrue(all(abs(one - other) < 2 for one, other in zip(size, A4)), size)
        return [sheet.extract_text() for sheet in pdf.pages]

    def test_pages_have_numbers_and_heads(self) -> None:
        pages = self.pages(Runs.passing() / "report.html", "passing")
        for number, text in enumerate(pages, 1):
            self.assertIn(f"page {number} of {len(pages)}", text)
            self.assertIn("Kinco servo drive – conformance report", text)
        self.assertIn("Passed", pages[0])

    def test_every_case_is_printed(self) -> None:
        pages = self.pages(Runs.failing() / "report.html", "failing")
        text = "".join("".join(pages).split())
        cases = Runs.events(Runs.failing(), "case-finished")
        for case in cases:
            self.assertIn("".join(case["id"].split("/", 1)[1].split()), text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
