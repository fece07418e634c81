"""How quick the scene is, in a browser that draws without a graphics card: a real one is quicker.

    python -m tools.scene_times                  100 vehicles on the motorway sample
    python -m tools.scene_times --vehicles 200

updates a second     poses that reach the scene of a live run at real time, whatever of them is drawn
playhead to scene    from asking for another time of a run that is over until its cars stand there, median
click to echo        from a click at a car until the camera has it, median
frames at rest       drawn in some seconds in which nothing changes, with a car followed; and while another page covers the scene
processor at rest    of one core, while nothing changes: by the server, and by the browser with the scene, and with another page over it
"""

import argparse
import statistics
import sys
import tempfile
import time
from pathlib import Path

import psutil

from tests.browser.browser import browser, watched
from tests.patience import until
from tests.server.server import served

SAMPLES = Path(__file__).resolve().parent.parent / "scenarios"
SCENARIO = "motorway_platoon"
NAMED = 6  # vehicles of the sample that are no traffic, at least
SECONDS = 8
REPEATS = 15

UPDATES = """async (seconds) => {
    const { poseOf } = window.__studioBridge;
    let count = 0, last = 0;
    const end = performance.now() + 1000 * seconds;
    while (performance.now() < end) {
        const x = poseOf(0)?.x;
        if (x !== last) [count, last] = [count + 1, x];
        await new Promise((resolve) => setTimeout(resolve, 2));
    }
    return count / seconds;
}"""
SEEK = """async ([run, time]) => {
    const scene = document.querySelector("iframe[title='3D scene']").contentWindow.__studioBridge;
    const before = scene.poseOf(0)?.x, began = performance.now();
    await fetch("/api/scene/time", { method: "PUT", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ run, time }) });
    while (scene.poseOf(0)?.x === before && performance.now() - began < 5000) await new Promise((resolve) => setTimeout(resolve, 1));
    return performance.now() - began;
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


def measure(client, opened, server: int, vehicles: int) -> dict[str, float]:
    """All figures of a server, by the number of its process, and a browser."""
    changes = {"traffic.count": vehicles - NAMED, "recording.traffic": True, "clock.duration": 60}
    live = client.post("/api/live", json={"scenario": SCENARIO, "set": changes, "pace": 1.0}).json()["run"]
    page, _ = watched(opened, viewport={"width": 1280, "height": 800})
    page.goto(f"{client.base_url}/studio/{SCENARIO}?run={live}")
    frame = page.get_by_test_id("scene-frame").element_handle().content_frame()
    # asked again and again from here: the page's policy lets no text become a program, and a frame has that until it is loaded
    until(lambda: frame.evaluate("window.__studioBridge?.poseOf(0) != null"), "the cars in the scene")
    until(lambda: client.get(f"/api/live/{live}").json()["time"] > 1.0, "the run to go on")
    found = {"updates a second": frame.evaluate(UPDATES, SECONDS)}
    client.post(f"/api/live/{live}/stop")
    page.get_by_role("toolbar", name="Playback").wait_for()
    end = client.get(f"/api/runs/{live}").json()["sim_time_s"]
    asked = [page.evaluate(SEEK, [live, end * (i % 7 + 1) / 9]) for i in range(REPEATS)]
    found["playhead to scene, median [ms]"] = statistics.median(asked)
    page.get_by_role("combobox", name="Follow a car").select_option("0")
    until(lambda: frame.evaluate(FRAMES, 3) == 0, "the scene to rest")
    found[f"frames at rest, of a followed car, in {SECONDS} s"] = frame.evaluate(FRAMES, SECONDS)
    found |= idle("scene", server)
    found["click to echo, median [ms]"] = statistics.median(clicked(page, frame))
    page.get_by_role("link", name="Runs", exact=True).first.click()
    found[f"frames under another page in {SECONDS} s"] = frame.evaluate(FRAMES, SECONDS)
    return found | idle("another page", server)


def idle(shown: str, server: int) -> dict[str, float]:
    """The share of one core [%] that the server and the browser take while nothing is asked of them."""
    browsers = [each for each in psutil.Process().children(recursive=True) if "chrom" in each.name()]
    begun, groups = time.monotonic(), {"server": family(server), "browser": browsers}
    before = {name: spent(group) for name, group in groups.items()}
    time.sleep(SECONDS)
    lasted = time.monotonic() - begun
    return {f"{name} at rest, {shown} [% of a core]": 100.0 * (spent(group) - before[name]) / lasted for name, group in groups.items()}


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
        for name, value in measure(client, opened, server.pid, wanted.vehicles).items():
            sys.stdout.write(f"{name:50} {value:8.1f}\n")
        opened.close()


if __name__ == "__main__":
    main()
