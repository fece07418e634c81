"""The scene in a real browser: a picture, motion in it, following, views, theme, and words to the page."""

import io
import shutil
import threading
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Frame, Page, sync_playwright

from studio.scene import pose
from studio.scene.fleet import Look
from studio.scene.projection import FROM, Scene, _overview
from tests.patience import PATIENCE_MS, until
from tests.server.stage import served

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
# a picture without a graphics card, from a browser that calls nobody
FLAGS = [
    *(
        "--headless=new",
        "--no-sandbox",
        "--use-gl=angle",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
    ),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run"),
]
WIDTH, HEIGHT = 640, 400
SPEED = 12.0  # [m/s]
LOOKS = [Look("leader", "#c2281d"), Look("follower_1", "#1f5fa8"), Look("traffic_01", "#d9d9d6")]


class Drive(threading.Thread):
    """Vehicles that go up the street at 50 Hz as far as they are told, in a slight bend so that they turn as well."""

    def __init__(self, scene: Scene) -> None:
        super().__init__(daemon=True)
        self.scene, self.ended = scene, threading.Event()
        self.time = self.goal = 0.0

    def run(self) -> None:
        while not self.ended.wait(0.02):
            self.time = min(self.time + 0.02, self.goal)
            self.scene.update(self.poses())

    def go(self, seconds: float) -> None:
        """So much further, in the vehicles' own time."""
        self.goal = self.time + seconds

    def poses(self) -> np.ndarray:
        s = (SPEED * self.time + np.array([120.0, 108.0, 90.0])) % 240.0 - 120.0
        poses = pose.standing(3)
        poses[pose.X], poses[pose.Y] = s, [-1.75, -1.75, 1.75] + 0.8 * np.sin(s / 15.0)
        poses[pose.YAW] = np.arctan(0.8 / 15.0 * np.cos(s / 15.0))
        poses[pose.WHEEL_ANGLE] = s / 0.316
        return poses


@pytest.fixture(scope="module")
def drive(town):
    scene = Scene()
    scene.show_city(town)
    scene.show_vehicles(LOOKS)
    scene.show_signals(np.array([0, 2], np.int8))
    driver = Drive(scene)
    driver.town = town
    driver.start()
    yield driver
    driver.ended.set()
    driver.join()
    scene.stop()


@pytest.fixture(scope="module")
def page(drive):
    found = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if found is None:
        pytest.skip("no browser: install one with `apt install chromium`, or put google-chrome on the PATH")
    with served(lambda: drive.scene.door) as port, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=found, headless=True, ignore_default_args=["--headless"], args=FLAGS)
        # some tests put the scene into a frame within itself, which its policy for browsers forbids
        shown = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT}, bypass_csp=True)
        shown.errors = []
        shown.on("pageerror", lambda error: shown.errors.append(str(error)))
        shown.set_default_timeout(PATIENCE_MS)
        # the frame posts to its parent; here the page is its own parent, so it stands in a frame of its own
        shown.goto(f"http://127.0.0.1:{port}/scene/?fixedDpr=1")
        shown.wait_for_function("window.__studioBridge?.poseOf(0) != null")
        shown.wait_for_function("window.__viserMutable.nodeRefFromName['/city/buildings'] != null")
        yield shown
        browser.close()


# Draws so many frames, and tells whether the camera was in the same place in all of them.
STILL = """async count => {
    const { client } = window.__studioBridge;
    const frame = () => window.__viserTestpoints.rendererInfo.render.frame;
    const where = () => client().camera.matrixWorld.elements.join() + client().camera.projectionMatrix.elements.join();
    const places = new Set();
    for (let i = 0; i < count; i++) {
        for (const before = frame(); frame() === before; ) {
            client().requestRender();
            await new Promise(requestAnimationFrame);
        }
        places.add(where());
    }
    return places.size === 1;
}"""


def rest(scene: Page | Frame) -> None:
    """Until everything that was said is drawn, and the camera has come to rest."""
    until(lambda: scene.evaluate(STILL, 6), "the camera to come to rest")


def arrived(page: Page, drive: Drive) -> None:
    """Until the vehicles stand where they were told to go, also in the picture."""
    until(lambda: drive.time == drive.goal, "the end of the drive")
    x, y = drive.poses()[[pose.X, pose.Y], 0]
    there = "([x, y]) => Math.hypot(__studioBridge.poseOf(0).x - x, __studioBridge.poseOf(0).y - y) < 0.01"
    page.wait_for_function(there, arg=[float(x), float(y)])
    rest(page)


def picture(page: Page) -> np.ndarray:
    rest(page)
    return np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB")).astype(float)


def say(page: Page, **message) -> None:
    """Tells the bridge something; it has heard it when this returns, because it listened first."""
    page.evaluate(
        """message => new Promise(done => {
            const hear = ({ data }) => {
                if (data?.studio !== message.studio) return;
                window.removeEventListener('message', hear);
                done();
            };
            window.addEventListener('message', hear);
            window.postMessage(message, location.origin);
        })""",
        message,
    )


def seen(page: Page, vehicle: int) -> tuple[float, float]:
    """Where a vehicle is in the next frame that is drawn, -1..1 from left to right and from bottom to top."""
    return tuple(page.evaluate(
        """vehicle => new Promise(done => {
            const { poseOf, toThree, client } = window.__studioBridge;
            const { scene, camera } = client();
            const before = scene.onAfterRender;
            // between two frames the vehicle is further already, and the camera is not
            scene.onAfterRender = () => {
                scene.onAfterRender = before;
                const { x, y, z } = poseOf(vehicle);
                done(camera.position.clone().set(...toThree([x, y, z + 0.7])).project(camera).toArray().slice(0, 2));
            };
            client().requestRender();
        })""",
        vehicle,
    ))  # fmt: skip


def place(page: Page, vehicle: int) -> np.ndarray:
    """Where a vehicle is in the street [m]."""
    return np.array(page.evaluate("vehicle => { const { x, y } = __studioBridge.poseOf(vehicle); return [x, y]; }", vehicle))


def test_the_picture_shows_something(page):
    shown = picture(page)
    assert shown.std() > 20.0
    # neither washed out nor black, and many tones
    assert 60.0 < shown.mean() < 220.0
    assert len(np.unique((shown // 16).astype(int).reshape(-1, 3), axis=0)) > 30


def test_sky_is_above_and_ground_below(page):
    say(page, studio="view", preset="driver")
    shown = picture(page)
    sky, ground = shown[: HEIGHT // 8].mean(axis=(0, 1)), shown[-HEIGHT // 3 :].mean(axis=(0, 1))
    assert sky[2] > sky[0] + 15.0
    assert sky[2] > ground[2] + 15.0
    say(page, studio="view", preset="overview")
    rest(page)


def test_only_the_picture_is_left_of_the_client(page):
    panels = "[data-floating-window], .mantine-Notifications-root, .mantine-Paper-root"
    assert all(not panel.is_visible() for panel in page.query_selector_all(panels))
    canvas = page.query_selector("canvas[data-engine]").bounding_box()
    assert (canvas["width"], canvas["height"]) == (WIDTH, HEIGHT)


def test_a_narrow_frame_shows_no_sheet_either(page):
    narrow(page, 420)
    sheets = page.query_selector_all(".mantine-Paper-root")
    assert all(not sheet.is_visible() for sheet in sheets)
    narrow(page, WIDTH)


def narrow(page: Page, width: int) -> None:
    """The window so wide, when the picture has followed."""
    page.set_viewport_size({"width": width, "height": HEIGHT})
    page.wait_for_function("width => document.querySelector('canvas[data-engine]').clientWidth === width", arg=width)
    rest(page)


def test_the_picture_stands_while_cars_stand_and_changes_when_they_move(page, drive):
    say(page, studio="view", preset="overview")
    still = np.abs(picture(page) - picture(page)).max()
    assert still < 3.0
    before = picture(page)
    drive.go(0.8)
    arrived(page, drive)
    changed = np.abs(picture(page) - before).max(axis=-1) > 25.0
    # cars are small from up there, and nothing but cars has moved
    assert 20 < changed.sum() < 0.1 * changed.size


def test_following_keeps_the_car_in_the_middle_while_it_drives(page, drive):
    say(page, studio="follow", vehicle=0)
    rest(page)
    start, places = place(page, 0), []
    drive.go(4.0)
    while drive.time < drive.goal:
        places.append(seen(page, 0))
    arrived(page, drive)
    places.append(seen(page, 0))
    assert np.hypot(*(place(page, 0) - start)) > 40.0
    assert len(places) > 1 and np.abs(places).max() < 0.3
    # from behind: the one ahead is seen further up than the one behind
    say(page, studio="follow", vehicle=1)
    rest(page)
    assert seen(page, 0)[1] > seen(page, 1)[1]
    say(page, studio="follow", vehicle=None)


def test_the_user_may_turn_and_zoom_while_following(page, drive):
    say(page, studio="follow", vehicle=0)
    rest(page)
    azimuth, distance = (page.evaluate(f"__viserMutable.cameraControl.{name}") for name in ("azimuthAngle", "distance"))
    page.mouse.move(WIDTH / 2, HEIGHT / 2)
    page.mouse.down()
    page.mouse.move(WIDTH / 2 + 120, HEIGHT / 2, steps=6)
    page.mouse.up()
    page.mouse.wheel(0, 300)
    page.wait_for_function("before => __viserMutable.cameraControl.distance > 1.1 * before", arg=distance)
    drive.go(1.0)
    arrived(page, drive)
    turned, zoomed = (page.evaluate(f"__viserMutable.cameraControl.{name}") for name in ("azimuthAngle", "distance"))
    assert abs(turned - azimuth) > 0.3 and zoomed > 1.1 * distance
    assert np.abs(seen(page, 0)).max() < 0.3
    say(page, studio="view", preset="overview")
    rest(page)


# How many triangles of a frame are cars: what there is less when their batches are not seen.
TRIANGLES = """async () => {
    const { client } = window.__studioBridge, info = window.__viserTestpoints.rendererInfo.render;
    const frame = async () => {
        for (const before = info.frame; info.frame === before; ) {
            client().requestRender();
            await new Promise(requestAnimationFrame);
        }
        return info.triangles;
    };
    const cars = [];
    for (const [name, node] of Object.entries(client().nodeRefFromName))
        if (name.startsWith('/vehicles/')) node?.traverse(({ material }) => material && cars.push(material));
    const all = await frame();
    for (const material of cars) material.visible = false;
    const others = await frame();
    for (const material of cars) material.visible = true;
    return all - others;
}"""


def test_who_is_far_is_drawn_with_few_triangles_and_who_is_near_with_all(page):
    say(page, studio="view", preset="top")
    say(page, studio="follow", vehicle=None)
    page.evaluate("__viserMutable.cameraControl.dollyTo(200, false)")
    page.evaluate("__viserMutable.cameraControl.moveTo(...__studioBridge.toThree([0, 0, 0]), false)")
    until(lambda: 0 < page.evaluate(TRIANGLES) < 3 * 1500, "the simpler shapes from afar")
    say(page, studio="follow", vehicle=0)
    rest(page)
    # the body and the wheels that are seen of it
    assert page.evaluate(TRIANGLES) > 8000
    say(page, studio="view", preset="overview")
    rest(page)


def test_moves_are_taken_in_while_no_picture_is_drawn(page, drive):
    """A picture may take long; where everything is has been taken in meanwhile, so that the next one shows it."""
    rest(page)
    page.evaluate("() => { [window.usual, window.held] = [requestAnimationFrame, []]; requestAnimationFrame = call => held.push(call); }")
    drawn = "__viserTestpoints.rendererInfo.render.frame"
    # what had been asked for before is drawn by then
    page.evaluate("new Promise(done => usual(() => usual(done)))")
    before, start = page.evaluate(drawn), page.evaluate("__studioBridge.poseOf(0).x")
    drive.go(0.2)
    until(lambda: page.evaluate("__studioBridge.poseOf(0).x") != start, "the move")
    assert page.evaluate(drawn) == before
    page.evaluate("() => { window.requestAnimationFrame = usual; for (const call of held) usual(call); }")
    arrived(page, drive)


def test_dusk_is_darker_than_day(page):
    day = picture(page).mean()
    say(page, studio="theme", dark=True)
    dusk = picture(page).mean()
    say(page, studio="theme", dark=False)
    assert dusk < 0.7 * day
    assert picture(page).mean() == pytest.approx(day, rel=0.05)


def framed(page: Page) -> Frame:
    """Put the scene into a frame of its own origin, and note what it tells its parent."""
    page.evaluate(
        """() => {
            window.heard = [];
            window.addEventListener('message', event => event.data?.studio && window.heard.push(event.data));
            const frame = document.createElement('iframe');
            frame.src = location.pathname + '?fixedDpr=1';
            frame.style = 'position:fixed;inset:0;width:100%;height:100%;border:0;z-index:9999';
            document.body.append(frame);
        }"""
    )
    page.wait_for_function("window.heard.some(message => message.studio === 'ready')")
    page.wait_for_function("frames[0].__studioBridge.poseOf(0) != null")
    return page.frames[1]


def follow_in_frame(page: Page, vehicle: int) -> None:
    """The page tells the scene in its frame which vehicle to follow, and sees that it does."""
    page.evaluate("vehicle => frames[0].postMessage({studio: 'follow', vehicle}, location.origin)", vehicle)
    page.wait_for_function("vehicle => frames[0].__studioBridge.view.vehicle === vehicle", arg=vehicle)
    rest(page.frames[1])


def test_the_page_around_hears_ready_picks_and_keys_and_the_frame_hears_the_page(page):
    framed(page)
    assert page.evaluate("heard.find(message => message.studio === 'ready').follow") is True
    follow_in_frame(page, 0)
    page.mouse.click(WIDTH / 2, HEIGHT / 2)
    page.wait_for_function("heard.some(message => message.studio === 'picked')")
    assert page.evaluate("heard.find(message => message.studio === 'picked').vehicle") == 0
    for key in ("Space", "w", "?"):
        page.keyboard.press(key)
    page.wait_for_function("heard.some(message => message.key === '?')")
    keys = page.evaluate("heard.filter(message => message.studio === 'key').map(message => message.key)")
    # W moves the camera and is not the page's
    assert keys == [" ", "?"]
    page.evaluate("document.querySelector('iframe').remove()")


def test_messages_of_another_origin_are_not_heard(page):
    page.evaluate(
        """() => {
            // the bridge listened first, so it has heard what is heard here
            window.addEventListener('message', event => event.origin === 'null' && (window.foreign = event.data));
            const frame = document.createElement('iframe');
            frame.sandbox = 'allow-scripts';
            frame.srcdoc = "<script>parent.postMessage({studio: 'follow', vehicle: 2}, '*')<" + "/script>";
            document.body.append(frame);
        }"""
    )
    page.wait_for_function("window.foreign?.vehicle === 2")
    assert page.evaluate("__studioBridge.view.vehicle") is None
    page.evaluate("document.querySelector('iframe').remove()")


STREETS = "__viserSceneTree.getState()['/city/road']?.message.props.glb_data"  # another object after every connection


def test_a_lost_connection_comes_back_without_the_focus(page, drive):
    framed(page)
    page.evaluate("document.body.append(Object.assign(document.createElement('input'), {id: 'elsewhere'}))")
    page.focus("#elsewhere")
    follow_in_frame(page, 1)
    before = page.evaluate_handle(f"frames[0].{STREETS}")
    server = drive.scene._server._websock_server
    until(lambda: len(server._live_connections) == 2, "both scenes")
    lost = set(server._live_connections)
    server.disconnect_all_clients()
    until(lambda: len(set(server._live_connections) - lost) == 2, "both scenes again")
    page.wait_for_function(f"before => ![undefined, before].includes(frames[0].{STREETS})", arg=before)
    page.wait_for_function("frames[0].__studioBridge.poseOf(0) != null")
    # the bridge looks at the streets as often as this counts
    page.frames[1].evaluate("() => new Promise(done => { let looks = 0; setInterval(() => ++looks === 4 && done(), 200); })")
    # the same city is no reason to let go of the vehicle
    assert page.evaluate("frames[0].__studioBridge.view.vehicle") == 1
    page.evaluate("document.querySelector('iframe').remove(); document.querySelector('#elsewhere').remove()")


CAST = [
    {"name": each.name, "index": i, "color": each.color, "length": 4.0, "width": 1.8, "height": 1.5, "middle": 0.0}
    for i, each in enumerate(LOOKS)
]
# How far from the middle of the map the camera looks at, when it has come to rest [m].
TARGET = "(({ x, z }) => Math.hypot(x, z))(__viserMutable.cameraControl.getTarget(__viserMutable.camera.position.clone(), true))"


def overview(page: Page, away: float) -> None:
    """The overview, as soon as the browser knows that it looks at a place about so far from the middle of the map [m]."""
    until(lambda: say(page, studio="view", preset="overview") or abs(page.evaluate(TARGET) - away) < 200.0, "the overview")


def test_an_overview_without_cars_goes_over_to_them_and_not_along(page, drive):
    say(page, studio="cast", cars=[])
    # as of a map of which only a part without cars is seen
    drive.scene._look_at(np.array([2000.0, 0.0]), 150.0, 150.0 * FROM)
    overview(page, 2000.0)
    rest(page)
    assert np.abs(seen(page, 0)).max() > 1.0
    say(page, studio="cast", cars=CAST)
    until(lambda: page.evaluate(TARGET) < 200.0, "the overview to find the cars")
    rest(page)
    assert np.abs([seen(page, 0), seen(page, 1)]).max() < 1.0
    # it stands there while they drive
    before = page.evaluate("__viserMutable.camera.position.toArray()")
    drive.go(2.0)
    arrived(page, drive)
    assert page.evaluate("__viserMutable.camera.position.toArray()") == pytest.approx(before, abs=0.01)


def test_an_overview_that_has_the_cars_is_of_the_whole_map(page, drive):
    middle, reach, away = _overview(drive.town, None)
    drive.goal = drive.time = 126.0 / SPEED  # the middle of the two own cars is that of the street
    arrived(page, drive)
    drive.scene._look_at(middle, reach, away)
    overview(page, np.hypot(*middle))
    rest(page)
    say(page, studio="cast", cars=CAST)
    say(page, studio="view", preset="overview")
    rest(page)
    assert page.evaluate(TARGET) == pytest.approx(np.hypot(*middle), abs=0.1)


def test_another_city_is_first_seen_as_a_whole(page, drive, town):
    say(page, studio="follow", vehicle=0)
    rest(page)
    short = tuple(replace(lane, centre=lane.centre * [[0.8], [1.0]], length=240.0) for lane in town.lanes)
    drive.scene.show_city(replace(town, lanes=short))
    page.wait_for_function("__studioBridge.view.vehicle === null")


def test_the_client_ran_without_errors_and_with_few_draw_calls(page):
    calls = page.evaluate("__viserTestpoints.rendererInfo.render.calls")
    assert 5 < calls <= 30
    assert page.errors == []
