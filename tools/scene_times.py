"""How quick the scene is, in a browser that draws without a graphics card: a real one is quicker.

    python -m tools.scene_times                  100 vehicles on the motorway sample
    python -m tools.scene_times --vehicles 200

moves a second       of a live run at real time: that come to the browser; that stand in its scene; and pictures that are drawn. The first
                     two are the studio's, the last is the drawing's, which without a graphics card depends on this machine alone
script of a picture  what the browser's program takes to have a picture drawn, and the whole until it is there, with its cars and without;
                     what is between the two is drawing
playhead to scene    from asking for another time of a run that is over until its cars stand there, and until they are seen there, median
click to echo        from a click at a car until the camera has it, median
frames at rest       drawn in some seconds in which nothing changes, with a car followed; and while another page covers the scene
processor at rest    of one core, while nothing changes: by the server, and by the browser with the scene, and with another page over it
"""

import argparse
import os
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import psutil

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

SAMPLES = Path(__file__).resolve().parent.parent / "scenarios"
SCENARIO = "motorway_platoon"
NAMED = 6  # vehicles of the sample that are no traffic, at least
SECONDS = 8
REPEATS = 9

MOVES = """async (seconds) => {
    const { poseOf, client } = window.__studioBridge, queue = client().messageQueue, push = queue.push;
    const frames = () => window.__viserTestpoints.rendererInfo.render.frame;
    let came = 0, stood = 0, last = poseOf(0)?.x;
    queue.push = function (...some) {
        for (const { name, updates } of some) if (name === "/vehicles/shadows" && updates?.batched_positions) came++;
        return push.apply(this, some);
    };
    const begun = performance.now(), drawn = frames();
    while (performance.now() < begun + 1000 * seconds) {
        const x = poseOf(0)?.x;
        if (x !== last) [stood, last] = [stood + 1, x];
        await new Promise((resolve) => setTimeout(resolve, 2));
    }
    delete queue.push;
    const lasted = (performance.now() - begun) / 1000;
    return [came / lasted, stood / lasted, (frames() - drawn) / lasted];
}"""
# The script of a picture, and the whole of it: nobody can read a point of it before it is there.
PICTURE = """async (hidden) => {
    const { client } = window.__studioBridge, { scene, canvas } = client(), point = new Uint8Array(4), left = [];
    const gl = canvas.getContext("webgl2"), [begin, end] = [scene.onBeforeRender, scene.onAfterRender];
    for (const [name, node] of Object.entries(client().nodeRefFromName))
        if (hidden && name.startsWith(hidden)) node?.traverse(({ material }) => material && left.push(material));
    for (const material of left) material.visible = false;
    let begun = 0, done = () => undefined;
    scene.onBeforeRender = (...what) => ((begun = performance.now()), begin(...what));
    scene.onAfterRender = (...what) => {
        end(...what);
        const script = performance.now() - begun;
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, point);
        done([script, performance.now() - begun]);
    };
    const all = [];
    for (let i = 0; i < 9; i++) {
        const drawn = new Promise((resolve) => (done = resolve));
        client().requestRender();
        all.push(await drawn);
    }
    Object.assign(scene, { onBeforeRender: begin, onAfterRender: end });
    for (const material of left) material.visible = true;
    const median = (k) => all.map((each) => each[k]).sort((a, b) => a - b)[4];
    return [median(0), median(1)];
}"""
SEEK = """async ([run, time]) => {
    const scene = document.querySelector("iframe[title='3D scene']").contentWindow, { poseOf, client } = scene.__studioBridge;
    const frames = () => scene.__viserTestpoints.rendererInfo.render.frame, soon = () => new Promise((resolve) => setTimeout(resolve, 1));
    const before = poseOf(0)?.x, began = performance.now(), gl = client().canvas.getContext("webgl2");
    const body = JSON.stringify({ run, time, layers: false });  // as the page asks first
    await fetch("/api/scene/time", { method: "PUT", headers: { "Content-Type": "application/json" }, body });
    while (poseOf(0)?.x === before && performance.now() - began < 5000) await soon();
    const there = performance.now() - began, drawn = frames();
    while (frames() === drawn && performance.now() - began < 5000) await soon();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return [there, performance.now() - began];
}"""
CLICK = """async (vehicle) => {
    const { view, poseOf, toThree, client } = window.__studioBridge;
    const canvas = client().canvas, box = canvas.getBoundingClientRect(), pose = poseOf(vehicle);
    const at = client().camera.position.clone().set(...toThree([pose.x, pose.y, pose.z + 0.7])).project(client().camera);
    const where = { clientX: box.left + ((at.x + 1) / 2) * box.width, clientY: box.top + ((1 - at.y) / 2) * box.height, bubbles: true };
    const before = view.vehicle, began = performance.now();
    for (const kind of ["pointerdown", "pointerup"]) canvas.dispatchEvent(new PointerEvent(kind, { ...where, button: 0 }));
    while (view.vehicle === before && performance.now() - began < 5000) await new Promise((resolve) => setTimeout(resolve, 1));
    return performance.now() - began;
}"""
FRAMES = """async (seconds) => {
    const frames = () => window.__viserTestpoints.rendererInfo.render.frame, before = frames();
    await new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
    return frames() - before;
}"""


def measure(client, opened, server: int, vehicles: int) -> Iterator[tuple[str, float]]:
    """All figures of a server, by the number of its process, and a browser, one after the other."""
    changes = {"traffic.count": vehicles - NAMED, "recording.traffic": True, "clock.duration": 60}
    live = client.post("/api/live", json={"scenario": SCENARIO, "set": changes, "pace": 1.0}).json()["run"]
    page, _ = watched(opened, viewport={"width": 1280, "height": 800})
    page.goto(f"{client.base_url}/studio/{SCENARIO}?run={live}")
    frame = page.get_by_test_id("scene-frame").element_handle().content_frame()
    # asked again and again from here: the page's policy lets no text become a program, and a frame has that until it is loaded
    until(lambda: frame.evaluate("window.__studioBridge?.poseOf(0) != null"), "the cars in the scene")
    until(lambda: client.get(f"/api/live/{live}").json()["time"] > 1.0, "the run to go on")
    came, stood, drawn = frame.evaluate(MOVES, SECONDS)
    yield from {"moves that come a second": came, "moves that stand in the scene a second": stood, "pictures a second": drawn}.items()
    client.post(f"/api/live/{live}/stop")
    page.get_by_role("toolbar", name="Playback").wait_for()
    yield from pictures(frame)
    end = client.get(f"/api/runs/{live}").json()["sim_time_s"]
    there, seen = zip(*(page.evaluate(SEEK, [live, end * (i % 7 + 1) / 9]) for i in range(REPEATS)), strict=True)
    yield "playhead to scene, median [ms]", statistics.median(there)
    yield "playhead to picture, median [ms]", statistics.median(seen)
    page.get_by_role("combobox", name="Follow a car").select_option("0")
    until(lambda: frame.evaluate(FRAMES, 2) == 0, "the scene to rest")
    yield f"frames at rest, of a followed car, in {SECONDS} s", frame.evaluate(FRAMES, SECONDS)
    yield from idle("scene", server)
    yield "click to echo, median [ms]", statistics.median(clicked(page, frame))
    page.get_by_role("link", name="Runs", exact=True).first.click()
    yield f"frames under another page in {SECONDS} s", frame.evaluate(FRAMES, SECONDS)
    yield from idle("another page", server)


def pictures(frame) -> Iterator[tuple[str, float]]:
    """What a picture takes, with and without the cars."""
    for hidden, what in (("", "a picture"), ("/vehicles/", "a picture without cars")):
        script, whole = frame.evaluate(PICTURE, hidden)
        yield f"script of {what}, median [ms]", script
        yield f"{what}, median [ms]", whole


def idle(shown: str, server: int) -> Iterator[tuple[str, float]]:
    """The share of one core [%] that the server and the browser take while nothing is asked of them."""
    browsers = [each for each in psutil.Process().children(recursive=True) if "chrom" in each.name()]
    begun, groups = time.monotonic(), {"server": family(server), "browser": browsers}
    before = {name: spent(group) for name, group in groups.items()}
    time.sleep(SECONDS)
    lasted = time.monotonic() - begun
    for name, group in groups.items():
        yield f"{name} at rest, {shown} [% of a core]", 100.0 * (spent(group) - before[name]) / lasted


def family(process: int) -> list[psutil.Process]:
    """A process and all that it has begun."""
    first = psutil.Process(process)
    return [first, *first.children(recursive=True)]


def spent(processes: list[psutil.Process]) -> float:
    """Time of processors [s] that processes have taken; one that has ended takes no more."""
    return sum(each.cpu_times().user + each.cpu_times().system for each in processes if each.is_running())


def clicked(page, frame) -> list[float]:
    """Times from clicks at the first and the second car in turn [ms], from above, where neither hides the other."""
    page.get_by_text("Top", exact=True).click()
    until(lambda: frame.evaluate(FRAMES, 2) == 0, "the scene to rest")
    times = []
    for i in range(REPEATS):
        times.append(frame.evaluate(CLICK, (i + 1) % 2))
        until(lambda: frame.evaluate(FRAMES, 1) == 0, "the scene to rest")
    return times


def main() -> None:
    """Measures and prints."""
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--vehicles", type=int, default=100)
    wanted = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder, browser() as opened, served(Path(folder), "--scenarios", SAMPLES) as (client, _, server):
        sys.stdout.write(f"{'load of the machine, before':50} {os.getloadavg()[0]:8.1f}\n")
        for name, value in measure(client, opened, server.pid, wanted.vehicles):
            sys.stdout.write(f"{name:50} {value:8.1f}\n")
            sys.stdout.flush()
        sys.stdout.write(f"{'load of the machine, after':50} {os.getloadavg()[0]:8.1f}\n")
        opened.close()


if __name__ == "__main__":
    main()
