# SPDX-License-Identifier: BSD-3-Clause
"""The report page in headless Chromium: what a person would try, and what they would see.

usage: ViewerInBrowserTest.py CSOM_PROGRAM SOURCE_FOLDER SCREENSHOT_FOLDER [TESTS…]
"""
import io
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from PIL import Image, ImageChops
from selenium import webdriver
from selenium.common.exceptions import TimeoutException
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.actions.pointer_input import PointerInput
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select, WebDriverWait

CSOM, SOURCE, SCREENSHOTS = (pathlib.Path(path).resolve() for path in sys.argv[1:4])


def start_browser(profile, webgl=True):
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars",
                     "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                     "--ignore-gpu-blocklist" if webgl else "--disable-3d-apis",
                     "--force-color-profile=srgb", "--window-size=1200,1000", f"--user-data-dir={profile}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def csom(*arguments):
    done = subprocess.run([CSOM, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"csom {arguments} ended with {done.returncode}:\n{done.stderr}")
    return done.stdout


def map_campus(folder, options):
    """Maps the drive of the repository with these keys set in its ini; returns the folder with the report."""
    text = (SOURCE / "config/campus.ini").read_text()
    for key, value in options.items():
        text = re.sub(rf"(?m)^{key} *=.*\n", "", text)
        text, changes = re.subn(r"(?m)^(\[.*_00_insertOpts\])$", rf"\1\n{key} = {value}", text)
        assert changes == 1, key
    config = folder / "campus.ini"
    config.write_text(text)
    csom("map", SOURCE / "rawlogs/campus.rawlog", "-c", config, "-o", folder / "out")
    return folder / "out"


def share_that_differs(a, b):
    difference = ImageChops.difference(a.convert("RGB"), b.convert("RGB")).convert("L")
    histogram = difference.histogram()
    return sum(histogram[24:]) / sum(histogram)


class BrowserTest(unittest.TestCase):
    options = {}
    webgl = True

    @classmethod
    def setUpClass(cls):
        SCREENSHOTS.mkdir(parents=True, exist_ok=True)
        cls.scratch = tempfile.TemporaryDirectory(prefix="csom-viewer-")
        cls.addClassCleanup(cls.scratch.cleanup)
        folder = pathlib.Path(cls.scratch.name)
        cls.out = map_campus(folder, cls.options)
        cls.browser = start_browser(folder / "profile", cls.webgl)
        cls.addClassCleanup(cls.browser.quit)

    def setUp(self):
        for kind in ("browser", "performance"):
            self.browser.get_log(kind)  # forgets those of the test before
        self.browser.set_window_size(1200, 1000)
        self.open()

    def open(self):
        self.browser.get((self.out / "report.html").as_uri())
        if self.webgl:
            self.wait_for_picture()

    # What is on the page

    def find(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def wait_for_picture(self, seconds=120):
        WebDriverWait(self.browser, seconds, poll_frequency=0.05).until(
            lambda _: self.canvas().get_attribute("data-picture") == "complete", "the picture is not complete")

    def canvas(self):
        return self.find("#viewer canvas")

    def picture(self, name=None):
        self.wait_for_picture()
        self.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", self.canvas())
        png = self.screenshot(self.canvas())
        if name:
            (SCREENSHOTS / f"{name}.png").write_bytes(png)
        return Image.open(io.BytesIO(png)).convert("RGB")

    @staticmethod
    def screenshot(element, tries=6):
        """The driver gives the browser 10 s to draw, which is less than it needs without a graphics card
        for a million voxels, if other tests run beside."""
        for left in range(tries - 1, -1, -1):
            try:
                return element.screenshot_as_png
            except TimeoutException:
                if left == 0:
                    raise

    def save_page(self, name):
        self.browser.save_screenshot(str(SCREENSHOTS / f"{name}.png"))

    def counts(self):
        """N and M of "You are looking at N of M occupied voxels."."""
        text = self.find(".count").text
        match = re.match(r"You are looking at ([\d,]+) of ([\d,]+) occupied voxels\.", text)
        self.assertTrue(match, text)
        return tuple(int(number.replace(",", "")) for number in match.groups())

    def class_line(self, name):
        for line in self.browser.find_elements(By.CSS_SELECTOR, ".classes li"):
            if line.find_element(By.TAG_NAME, "label").text.strip() == name:
                return line
        raise AssertionError(f"no class {name} in the legend")

    def assert_changed(self, before, after, least=0.002):
        self.assertGreater(share_that_differs(before, after), least)


class ViewerTest(BrowserTest):
    def test_opens_without_errors_or_requests(self):
        page = (self.out / "report.html").as_uri()
        self.save_page("report")
        self.assertEqual(self.browser.get_log("browser"), [])
        requested = []
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                requested.append(message["params"]["request"]["url"])
        outside = [url for url in requested if url != page and not url.startswith(("data:", "blob:"))]
        self.assertIn(page, requested)  # else this would see nothing at all
        self.assertEqual(outside, [])

    def test_shows_the_map_in_the_colours_of_its_classes(self):
        picture = self.picture("campus-oblique")
        colors = picture.getcolors(picture.width * picture.height)
        self.assertGreater(len(colors), 200)
        run = json.loads((self.out / "run.json").read_text())
        shown = {color for _, color in colors}
        for name in ("building", "road", "car", "vegetation"):
            color = next(c["color"] for c in run["map"]["classes"] if c["name"] == name)
            # Shading darkens all channels alike.
            alike = [c for c in shown if max(color) * 0.5 < max(c) and
                     all(abs(a / max(c) - b / max(color)) < 0.05 for a, b in zip(c, color))]
            self.assertTrue(alike, f"nothing is coloured like {name}")
        self.assertEqual(self.counts(), 2 * (run["map"]["occupied_voxels"],))

    def test_legend_switches_classes(self):
        before = self.picture()
        shown, everything = self.counts()
        line = self.class_line("building")
        buildings = int(line.find_element(By.CLASS_NAME, "number").text.replace(",", ""))
        line.find_element(By.TAG_NAME, "input").click()
        after = self.picture("campus-without-buildings")
        self.assert_changed(before, after, 0.01)
        self.assertEqual(self.counts(), (shown - buildings, everything))
        self.find("[data-classes=none]").click()
        self.assertEqual(self.counts(), (0, everything))
        self.find("[data-classes=all]").click()
        self.assertEqual(self.counts(), (everything, everything))
        self.assertEqual(share_that_differs(before, self.picture()), 0)

    def test_height_slice(self):
        before = self.picture()
        everything = self.counts()[1]
        slider = self.find("#viewer-highest")
        told = self.find("output[for=viewer-highest]")
        layers = round((float(told.text.rstrip(" m")) - 4) / 0.2)
        self.assertGreater(layers, 10)
        slider.send_keys(*layers * [Keys.ARROW_LEFT])
        WebDriverWait(self.browser, 120).until(lambda _: told.text == "4 m", "the slider does not tell its height")
        after = self.picture("campus-below-4-metres")
        self.assert_changed(before, after)
        of_slice = sum(1 for line in csom("export", self.out / "map.csom", "--to", "csv", "-o", "/dev/stdout")
                       .splitlines()[1:] if float(line.split(",")[2]) < 4.0)
        self.assertEqual(self.counts(), (of_slice, everything))
        self.find("#viewer-lowest").send_keys(Keys.END)  # pushes the other along
        self.assertEqual(slider.get_attribute("value"), slider.get_attribute("max"))

    def test_click_shows_the_class_vector_that_the_map_has(self):
        self.find("[data-view=top]").click()
        self.picture()
        ActionChains(self.browser).move_to_element(self.canvas()).click().perform()
        box = self.find("#viewer .voxel")
        if not box.is_displayed():  # a gap in the middle
            self.click_somewhere_on_the_map()
        self.assertTrue(box.is_displayed())
        self.picture("campus-voxel")
        self.save_page("campus-voxel-page")
        self.assert_is_in_the_map(box)
        box.find_element(By.CLASS_NAME, "close").click()
        self.assertFalse(box.is_displayed())

    def click_somewhere_on_the_map(self):
        canvas = self.canvas()
        for offset in range(-200, 200, 20):
            ActionChains(self.browser).move_to_element_with_offset(canvas, offset, 0).click().perform()
            if self.find("#viewer .voxel").is_displayed():
                return

    def assert_is_in_the_map(self, box):
        place = re.search(r"At ([-\d.]+), ([-\d.]+), ([-\d.]+) m\.", box.text)
        self.assertTrue(place, box.text)
        answer = json.loads(csom("query", self.out / "map.csom", "--point", ",".join(place.groups()), "--json"))
        rows = [(row.find_elements(By.TAG_NAME, "td")[0].text.strip(),
                 float(row.find_elements(By.TAG_NAME, "td")[2].text.rstrip(" %")) / 100)
                for row in box.find_elements(By.TAG_NAME, "tr")]
        self.assertEqual(rows[0][0], answer["class_name"])
        self.assertAlmostEqual(rows[0][1], answer["probability"], delta=0.005)
        self.assertAlmostEqual(sum(share for _, share in rows), 1, delta=0.02)
        evidence = float(re.search(r"Evidence ([\d.,]+)", box.text).group(1).rstrip(".,").replace(",", ""))
        self.assertAlmostEqual(evidence / answer["evidence"], 1, delta=0.05)

    def test_every_colouring_shows_something_else(self):
        pictures = {}
        choice = Select(self.find("#viewer-color"))
        for mode in ("class", "class-safe", "probability", "variance", "evidence", "height"):
            choice.select_by_value(mode)
            pictures[mode] = self.picture(f"campus-by-{mode}")
            self.assertEqual(self.find("#viewer .scale").is_displayed(), not mode.startswith("class"))
        modes = list(pictures)
        for i, mode in enumerate(modes):
            for other in modes[:i]:
                self.assert_changed(pictures[other], pictures[mode], 0.02)

    def test_mouse_turns_moves_and_zooms(self):
        canvas = self.canvas()
        before = self.picture()
        ActionChains(self.browser).drag_and_drop_by_offset(canvas, 120, 40).perform()
        turned = self.picture()
        self.assert_changed(before, turned, 0.05)
        # With the right button.
        mouse = ActionBuilder(self.browser)
        mouse.pointer_action.move_to(canvas).pointer_down(button=2).move_to(canvas, 80, 60).pointer_up(button=2)
        mouse.perform()
        moved = self.picture()
        self.assert_changed(turned, moved, 0.05)
        self.browser.execute_script("arguments[0].focus()", canvas)
        ActionChains(self.browser).move_to_element(canvas).perform()
        self.browser.execute_script(
            "arguments[0].dispatchEvent(new WheelEvent('wheel', {deltaY: -300, bubbles: true, cancelable: true}))",
            canvas)
        self.assert_changed(moved, self.picture(), 0.05)

    def test_a_finger_turns(self):
        before = self.picture()
        finger = ActionBuilder(self.browser, mouse=PointerInput("touch", "finger"))
        finger.pointer_action.move_to(self.canvas()).pointer_down().move_to(self.canvas(), 100, 30).pointer_up()
        finger.perform()
        self.assert_changed(before, self.picture(), 0.05)

    def test_keyboard_does_it_all(self):
        canvas = self.canvas()
        canvas.send_keys("0")
        start = self.picture()  # with the frame that says where the keys go
        for keys in ((Keys.ARROW_LEFT,), (Keys.SHIFT, Keys.ARROW_UP), ("+",), ("-", "-")):
            before = self.picture()
            canvas.send_keys(*keys)
            self.assert_changed(before, self.picture(), 0.01)
        canvas.send_keys("0")
        self.assertLess(share_that_differs(start, self.picture()), 0.002)
        canvas.send_keys(Keys.ENTER)
        self.assertTrue(self.find("#viewer .voxel").is_displayed())
        canvas.send_keys(Keys.ESCAPE)
        self.assertFalse(self.find("#viewer .voxel").is_displayed())

    def test_every_control_is_reached_by_tab_and_has_a_name(self):
        controls = self.browser.find_elements(
            By.CSS_SELECTOR, "#viewer canvas, #viewer button, #viewer select, #viewer input")
        names = {control.id: control.accessible_name for control in controls if control.is_displayed()}
        self.assertGreater(len(names), 15)
        self.assertEqual([name for name in names.values() if not name], [])
        self.browser.execute_script("arguments[0].focus()", self.canvas())
        reached = set()
        for _ in range(len(names) + 3):
            reached.add(self.browser.switch_to.active_element.id)
            self.browser.switch_to.active_element.send_keys(Keys.TAB)
        self.assertEqual([name for control, name in names.items() if control not in reached], [])

    def test_the_path_of_the_sensor_can_be_hidden(self):
        before = self.picture()
        self.find("#viewer-trajectory").click()
        self.assert_changed(before, self.picture(), 0.0005)

    def test_fits_a_phone(self):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True})
        try:
            self.open()
            self.save_page("phone")
            width = self.browser.execute_script("return document.scrollingElement.scrollWidth")
            self.assertLessEqual(width, 390)
            self.picture("phone-viewer")
        finally:
            self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    def test_dark_and_paper(self):
        def emulate(media, scheme):
            self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {
                "media": media, "features": [{"name": "prefers-color-scheme", "value": scheme}]})

        def background():
            return self.browser.execute_script("return getComputedStyle(document.body).backgroundColor")

        emulate("", "light")
        light = background()
        try:
            emulate("", "dark")
            self.assertNotEqual(background(), light)
            self.save_page("dark")
            emulate("print", "dark")
            # Nobody prints a black page, and nothing turns on paper.
            self.assertEqual(background(), light)
            self.assertFalse(self.find("#viewer").is_displayed())
            self.save_page("paper")
        finally:
            emulate("", "light")


class MillionVoxelsTest(BrowserTest):
    options = {"resolution": 0.1, "method": "see-csom"}

    def test_is_small_and_complete(self):
        before = self.picture("million-voxels")
        shown, everything = self.counts()
        self.assertGreater(everything, 1_000_000)
        self.assertEqual(shown, everything)
        self.assertLess((self.out / "report.html").stat().st_size, 30_000_000)
        first, complete = (self.browser.execute_script(
            f"return performance.getEntriesByName('csom-{which}-picture')[0].startTime / 1000")
            for which in ("first", "complete"))
        print(f"{everything:,} voxels: first picture after {first:.1f} s, complete after {complete:.1f} s,",
              f"page of {(self.out / 'report.html').stat().st_size / 1e6:.1f} MB")
        self.assertLessEqual(first, complete)
        self.canvas().send_keys(Keys.ARROW_LEFT)
        self.assert_changed(before, self.picture(), 0.01)


class NoWebGlTest(BrowserTest):
    webgl = False

    def test_says_so_and_shows_the_pictures(self):
        told = WebDriverWait(self.browser, 120).until(lambda _: self.find("#viewer.failed .status"))
        self.assertIn("cannot show the map in three dimensions", told.text)
        self.assertFalse(self.find("#viewer .controls").is_displayed())
        pictures = self.browser.find_elements(By.CSS_SELECTOR, ".gallery img")
        self.assertEqual(len(pictures), 4)
        for picture in pictures:
            self.assertGreater(int(picture.get_property("naturalWidth")), 300)
            self.assertTrue(picture.get_attribute("alt"))
        self.save_page("without-webgl")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
