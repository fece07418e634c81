"""What the projection puts on the viser server: where vehicles go, what is reused, what is hidden."""

import threading

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from studio.scene import fleet, light, pose
from studio.scene.fleet import Look
from studio.scene.obstacle import Place
from studio.scene.projection import Scene
from studio.scene.vehicle import Dimensions

LOOKS = [Look("leader", "#c2281d"), *(Look(f"follower_{i}", "#1f5fa8") for i in range(1, 5))]
LOOKS += [Look(f"traffic_{i:02d}", ["#d9d9d6", "#3c4248", "#8e9499", "#b59f7b"][i % 4]) for i in range(1, 21)]


@pytest.fixture(scope="module")
def scene(town):
    shown = Scene()
    shown.show_city(town)
    shown.show_vehicles(LOOKS)
    yield shown
    shown.stop()


def node(scene: Scene, name: str):
    return scene._server.scene.get_handle_by_name(name)


def poses() -> np.ndarray:
    some = pose.standing(len(LOOKS))
    some[pose.X] = np.arange(len(LOOKS)) * 10.0
    return some


def test_turns_are_yaw_then_pitch_then_roll():
    angles = np.random.default_rng(1).uniform(-1.5, 1.5, (3, 50))
    got = fleet.quaternions(*angles)
    expected = Rotation.from_euler("ZYX", angles.T).as_quat(scalar_first=True)
    same = np.abs(np.sum(got * expected, axis=1))
    np.testing.assert_allclose(same, 1.0, atol=1e-9)


def test_bodies_and_shadows_go_where_the_poses_say(scene):
    where = poses()
    where[pose.Y, 3], where[pose.YAW, 3] = 7.0, 0.5
    scene.update(where)
    # instance i of the shadows is vehicle i: the bridge relies on it for following
    shadows = node(scene, "/vehicles/shadows")
    np.testing.assert_allclose(shadows.batched_positions[3, :2], [30.0, 7.0], atol=1e-5)
    np.testing.assert_allclose(shadows.batched_wxyzs[3], [np.cos(0.25), 0, 0, np.sin(0.25)], atol=1e-6)
    bodies = node(scene, "/vehicles/body_1")
    np.testing.assert_allclose(bodies.batched_positions[2], [30.0, 7.0, 0.0], atol=1e-5)


def test_wheels_stand_on_the_road_steer_and_spin(scene):
    where = poses()
    where[pose.YAW, 0], where[pose.STEER, 0], where[pose.WHEEL_ANGLE, 0] = np.pi / 2, 0.3, 1.0
    where[pose.ROLL, 0], where[pose.PITCH, 0] = 0.1, 0.1
    scene.update(where)
    wheels = node(scene, "/vehicles/wheels")
    size = Dimensions()
    np.testing.assert_allclose(wheels.batched_positions[0], [-size.track / 2, size.front_axle, size.wheel_radius], atol=1e-5)
    front = Rotation.from_quat(wheels.batched_wxyzs[0], scalar_first=True)
    rear = Rotation.from_quat(wheels.batched_wxyzs[2], scalar_first=True)
    # the axle turns with yaw and steer and stays level; a mark on the rim goes round forwards
    axle = front.apply([0.0, 1.0, 0.0])
    np.testing.assert_allclose(axle, [-np.cos(0.3), -np.sin(0.3), 0.0], atol=1e-6)
    np.testing.assert_allclose(rear.apply([0.0, 0.0, 1.0]), [0.0, np.sin(1.0), np.cos(1.0)], atol=1e-6)


def test_hidden_vehicles_are_far_below_the_ground(scene):
    where = poses()
    where[pose.VISIBLE, 2] = 0.0
    scene.update(where)
    assert node(scene, "/vehicles/shadows").batched_positions[2, 2] < -100.0
    assert node(scene, "/vehicles/body_1").batched_positions[1, 2] < -100.0
    assert (node(scene, "/vehicles/wheels").batched_positions[8:12, 2] < -100.0).all()


def test_frames_reuse_the_nodes(scene):
    before = {name: node(scene, name) for name in ("/vehicles/body_0", "/vehicles/wheels", "/vehicles/shadows")}
    for step in range(5):
        where = poses()
        where[pose.X] += step
        scene.update(where)
    assert all(node(scene, name) is handle for name, handle in before.items())


PAINTS = ["#d9d9d6", "#3c4248", "#8e9499", "#b59f7b"]
FLOAT = 4  # [bytes]
POSE = 3 * FLOAT + 4 * FLOAT  # a place and a turn
PARTS = 1 + 4 + 2  # of a car: its body, its wheels, two shadows


def sent(scene: Scene, monkeypatch, poses: np.ndarray) -> list[dict]:
    """What is sent to browsers for one update, message by message."""
    messages = []
    with monkeypatch.context() as patched:
        patched.setattr(scene._server._websock_server, "queue_message", messages.append)
        scene.update(poses)
    return [each.updates for each in messages]


@pytest.mark.parametrize("count", [8, 100])
def test_an_update_has_as_many_messages_as_there_are_batches_however_many_cars_there_are(count, monkeypatch):
    scene = Scene()
    try:
        scene.show_vehicles([Look(f"traffic_{i}", PAINTS[i % len(PAINTS)]) for i in range(count)])
        where = pose.standing(count)
        where[pose.YAW] = 1.0
        updates = sent(scene, monkeypatch, where)
        # places and turns of the bodies of each paint, of the wheels, and of the shadows
        assert len(updates) == 2 * (len(PAINTS) + 2)
        assert sum(value.nbytes for update in updates for value in update.values()) == count * PARTS * POSE
    finally:
        scene.stop()


def test_nothing_is_sent_while_nobody_moves(scene, monkeypatch):
    where = poses() + np.float32(0.25)
    assert sent(scene, monkeypatch, where)
    assert sent(scene, monkeypatch, where.copy()) == []
    where[pose.X, 0] += 0.01
    assert sent(scene, monkeypatch, where)


def test_who_is_far_has_fewer_points_and_the_same_outline(scene):
    """The bridge takes the shapes up by their names, which say from how far on they are seen."""
    names = [name for name in scene._server.scene._handle_from_node_name if name.startswith("/afar/")]
    assert {name.split("/")[2] for name in names} == {"wheels", "shadows", *(f"body_{i}" for i in range(6))}
    for shapes in (fleet.bodies(Dimensions(), "#1f5fa8"), fleet.wheels(Dimensions()), fleet.shadows(Dimensions())):
        near, *others = shapes.values()
        for other in others:
            assert len(other.faces) <= 0.5 * len(near.faces)
            # whose width differs by the mirrors
            assert (np.abs(np.ptp(other.vertices, axis=0) - np.ptp(near.vertices, axis=0)) < [0.05, 0.25, 0.01]).all()
            near = other


def test_one_batch_per_colour(scene):
    colours = {look.color for look in LOOKS}
    bodies = [name for name in scene._server.scene._handle_from_node_name if name.startswith("/vehicles/body_")]
    assert len(bodies) == len(colours)


def test_new_vehicles_replace_the_old_ones(town):
    scene = Scene()
    try:
        scene.show_vehicles(LOOKS)
        scene.show_vehicles(LOOKS[:1])
        assert node(scene, "/vehicles/body_1") is None
        scene.update(pose.standing(1))
        assert len(node(scene, "/vehicles/wheels").batched_positions) == 4
        scene.show_vehicles([])
        scene.update(pose.standing(0))
    finally:
        scene.stop()


def test_lamps_follow_the_states_and_cost_nothing_when_they_do_not_change(scene):
    def lit(name):
        return node(scene, f"/signals/{name}").batched_positions[:, 2] > 0.0

    # RED, RED_AMBER, GREEN, AMBER
    for state, red, amber, green in [(0, 1, 0, 0), (1, 1, 1, 0), (2, 0, 0, 1), (3, 0, 1, 0)]:
        scene.show_signals(np.array([state, 0], np.int8))
        assert (lit("red")[0], lit("amber")[0], lit("green")[0]) == (bool(red), bool(amber), bool(green))
        assert lit("red")[1] and not lit("green")[1]


def test_another_city_takes_the_place_of_the_first(town):
    scene = Scene()
    try:
        scene.show_city(town)
        first = set(scene._server.scene._handle_from_node_name)
        scene.show_city(town)
        assert set(scene._server.scene._handle_from_node_name) == first
    finally:
        scene.stop()


def test_any_thread_may_update(scene):
    failures = []

    def drive(offset: float):
        try:
            for step in range(50):
                where = poses()
                where[pose.X] += offset + step
                scene.update(where)
        except Exception as error:
            failures.append(error)

    threads = [threading.Thread(target=drive, args=(1000.0 * i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failures == []


def test_viser_does_not_print_an_address_of_its_own(capsys):
    Scene().stop()
    printed = capsys.readouterr()
    assert printed.out == printed.err == ""


def test_nobody_can_open_a_public_tunnel(scene):
    assert scene._server.request_share_url() is None
    assert scene._server._websock_server._host == "127.0.0.1"


def test_objects_come_and_go(scene):
    """One batch per kind; what does not stand is far below the ground; nothing is sent when nothing has changed."""
    scene.show_obstacles([Place("cone", 1.0, 2.0, 0.0), Place("barrier", 5.0, 6.0, np.pi / 2), Place("cone", 3.0, 4.0, 0.0)])
    cones, barriers = node(scene, "/obstacles/cones"), node(scene, "/obstacles/barriers")
    assert (cones.batched_positions[:, 2] < -100.0).all() and (barriers.batched_positions[:, 2] < -100.0).all()
    where = np.array([[1.0, 5.0, 3.0], [2.0, 6.0, 4.0], [0.0, np.pi / 2, 0.0], [0.0, 0.0, 5.5]], np.float32)
    scene.update_obstacles(np.array([1, 1, 0], np.int8), where)
    np.testing.assert_allclose(cones.batched_positions[0], [1.0, 2.0, 0.0])
    assert cones.batched_positions[1, 2] < -100.0
    np.testing.assert_allclose(barriers.batched_positions[0], [5.0, 6.0, 0.0])
    np.testing.assert_allclose(barriers.batched_wxyzs[0], [np.sqrt(0.5), 0, 0, np.sqrt(0.5)], atol=1e-6)
    before = cones.batched_positions
    scene.update_obstacles(np.array([1, 1, 0], np.int8), where)
    assert cones.batched_positions is before
    scene.show_obstacles([])
    assert node(scene, "/obstacles/cones") is None


def test_who_walks_is_shown_where_he_is(scene):
    """Somebody on foot, a cyclist who turns, and a box of its size."""
    start = [Place("pedestrian", 1.0, 2.0, 0.0), Place("cyclist", 5.0, 6.0, 0.0), Place("box", 7.0, 8.0, 0.0, (2.0, 0.5))]
    scene.show_obstacles(start)
    where = np.array([[1.5, 5.0, 7.0], [2.0, 6.5, 8.0], [0.0, np.pi / 2, 0.0], [0.0, 0.0, 5.5]], np.float32)
    scene.update_obstacles(np.ones(3, np.int8), where)
    np.testing.assert_allclose(node(scene, "/obstacles/pedestrians").batched_positions[0], [1.5, 2.0, 0.0])
    np.testing.assert_allclose(node(scene, "/obstacles/cyclists").batched_wxyzs[0], [np.sqrt(0.5), 0, 0, np.sqrt(0.5)], atol=1e-6)
    np.testing.assert_allclose(node(scene, "/obstacles/boxs").batched_scales[0], [2.0, 0.5, 1.0])
    np.testing.assert_allclose(node(scene, "/obstacles/boxs").batched_positions[0], [7.0, 8.0, 5.5])  # on a bridge


def test_fog_hides_what_is_farther_than_one_sees(scene, monkeypatch):
    """The fog ends at the visibility, and hides the blue of the sky; in clear air both are as before."""
    ends = []
    monkeypatch.setattr(scene._server.scene, "configure_fog", lambda near, far, **look: ends.append(far))
    clear = node(scene, "/city/sky").glb_data
    scene.show_weather(120.0)
    assert node(scene, "/city/sky").glb_data != clear
    scene.show_weather(10_000.0)
    scene.show_weather(20_000.0)
    assert node(scene, "/city/sky").glb_data == clear
    assert ends == [120.0, light.HAZE_FAR]
