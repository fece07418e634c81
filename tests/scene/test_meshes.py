"""Meshes: bodies are closed and face outward, have the sizes that were asked for, and survive the file."""

import io
import json
import struct
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from PIL import Image

from studio.road import kept
from studio.road.network import Post, Wall
from studio.scene import city, obstacle, signal, vehicle
from studio.scene.city import building, tree, upright
from studio.scene.colour import linear, linear8, rgb8
from studio.scene.glb import Material, glb
from studio.scene.light import SUN, sky
from studio.scene.shape import ball, box, cylinder, surface

CAR = vehicle.Dimensions()
VAN = vehicle.Dimensions(length=5.2, width=1.98, height=2.3, wheelbase=3.2, wheel_radius=0.34, front_axle=1.5)
PALETTE = ["#b3261e", *vehicle.PARTS[1:]]


def solid(mesh) -> trimesh.Trimesh:
    """The surface with its doubled vertices joined, as geometry sees it."""
    points, same = np.unique(np.round(mesh.vertices, 5), axis=0, return_inverse=True)
    faces = same.ravel()[mesh.faces.astype(np.int64)]
    whole = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return trimesh.Trimesh(points, faces[whole], process=False)


DETAILS = {"fine": vehicle.FINE, "middling": vehicle.MIDDLING, "coarse": vehicle.COARSE}


@pytest.mark.parametrize("size", [CAR, VAN], ids=["car", "van"])
@pytest.mark.parametrize("part", [vehicle.hull, vehicle.cabin])
@pytest.mark.parametrize("detail", DETAILS.values(), ids=DETAILS)
def test_body_parts_are_closed_and_face_outward(size, part, detail):
    body = solid(part(size, PALETTE, detail))
    assert body.is_watertight and body.is_winding_consistent
    assert body.volume > 0.0


@pytest.mark.parametrize("size", [CAR, VAN], ids=["car", "van"])
@pytest.mark.parametrize("made", [vehicle.wheel, lambda size: vehicle.plain_wheel(size, segments=16)], ids=["near", "far"])
def test_wheel_is_closed_round_and_as_wide_as_asked(size, made):
    wheel = solid(made(size))
    assert wheel.is_watertight and wheel.volume > 0.0
    assert np.hypot(wheel.vertices[:, 0], wheel.vertices[:, 2]).max() == pytest.approx(size.wheel_radius, abs=1e-4)
    assert np.ptp(wheel.vertices[:, 1]) == pytest.approx(size.wheel_width, abs=1e-4)


@pytest.mark.parametrize("size", [CAR, VAN], ids=["car", "van"])
def test_car_has_its_dimensions_and_stands_on_its_wheels(size):
    body = vehicle.body(size, "#b3261e")
    low, high = body.vertices.min(axis=0), body.vertices.max(axis=0)
    # number plates stand out by some millimetres, mirrors on both sides by some centimetres
    assert high[0] - low[0] == pytest.approx(size.length, abs=0.05)
    assert size.width <= high[1] - low[1] <= size.width + 0.4
    assert high[2] == pytest.approx(size.height, abs=0.06)
    assert 0.1 < low[2] < size.wheel_radius
    assert low[0] < size.axles[1] < size.axles[0] < high[0]
    assert (low[1] + high[1]) == pytest.approx(0.0, abs=1e-5)


@pytest.mark.parametrize("size", [CAR, VAN], ids=["car", "van"])
def test_wheels_fit_into_their_arches(size):
    hull = vehicle.hull(size, PALETTE).vertices
    for axle in size.axles:
        away = np.hypot(hull[:, 0] - (axle - size.centre), hull[:, 2] - size.wheel_radius)
        assert away.min() > 1.05 * size.wheel_radius


def test_the_file_holds_what_was_put_in():
    shape = vehicle.body(CAR, "#1f5fa8")
    data = glb(shape, Material(roughness=0.28))
    scene = trimesh.load(io.BytesIO(data), file_type="glb", process=False)
    (mesh,) = scene.geometry.values()
    np.testing.assert_allclose(mesh.vertices, shape.vertices, atol=1e-6)
    np.testing.assert_array_equal(mesh.faces, shape.faces)
    document = json.loads(data[20 : 20 + struct.unpack_from("<I", data, 12)[0]])
    look = document["materials"][0]["pbrMetallicRoughness"]
    assert look == {"metallicFactor": 0.0, "roughnessFactor": 0.28}
    assert set(document["meshes"][0]["primitives"][0]["attributes"]) == {"POSITION", "NORMAL", "COLOR_0"}
    assert struct.unpack_from("<I", data, 8)[0] == len(data)


def test_normals_are_unit_and_smooth_only_within_a_round_part():
    sphere = ball((1.0, 1.0, 1.0), "#ffffff", segments=24)
    outward = sphere.vertices / np.linalg.norm(sphere.vertices, axis=1, keepdims=True)
    assert (np.sum(sphere.normals * outward, axis=1) > 0.97).all()
    # every corner of a box belongs to one face only
    edges = np.abs(box((1.0, 2.0, 3.0), "#ffffff").normals)
    np.testing.assert_allclose(np.sort(edges, axis=1), np.tile([0.0, 0.0, 1.0], (36, 1)), atol=1e-6)


def test_box_and_cylinder_have_their_volumes():
    assert solid(box((1.0, 2.0, 3.0), "#ffffff")).volume == pytest.approx(6.0)
    prism = solid(cylinder(0.5, 2.0, "#ffffff", segments=64))
    # area of a regular polygon with 64 corners
    assert prism.is_watertight
    assert prism.volume == pytest.approx(2.0 * 0.5 * 64 * 0.5**2 * np.sin(2 * np.pi / 64), rel=1e-5)


def test_shadow_is_dark_below_the_car_and_gone_at_its_rim():
    shade = vehicle.shadow(CAR)
    reach = np.maximum(
        np.abs(shade.vertices[:, 0] - CAR.centre) - CAR.length / 2,
        np.abs(shade.vertices[:, 1]) - CAR.width / 2,
    )
    assert shade.colors[np.argmin(reach), 3] > 0.5
    assert shade.colors[reach > 0.2, 3].max() == 0.0
    assert (shade.vertices[:, 2] == 0.0).all() and (shade.normals[:, 2] > 0.99).all()


def test_white_is_white_and_half_grey_is_darker_in_linear_light():
    assert rgb8("#ffffff") == linear8("#ffffff") == (255, 255, 255)
    # IEC 61966-2-1: sRGB 0.5 is linear 0.2140
    assert linear("#808080")[0] == pytest.approx(0.2159, abs=1e-3)


def test_buildings_are_prisms_with_holes(town):
    mesh, uv = building.buildings_surface(town.scenery.buildings)
    floor = mesh.vertices[:, 2] == 0.0
    assert set(np.unique(mesh.vertices[:, 2])) == {0.0, 12.0, 30.0}
    assert len(uv) == len(mesh.vertices) and floor.any()
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(float) for i in range(3))
    area = np.cross(b - a, c - a) / 2.0
    roofs = area[:, 2] > 1e-6
    # 16 m by 16 m with a yard of 4 m by 4 m, and 10 m by 10 m
    assert area[roofs, 2].sum() == pytest.approx(16**2 - 4**2 + 10**2)
    walls = np.linalg.norm(area[~roofs], axis=1).sum()
    assert walls == pytest.approx(12 * (4 * 16 + 4 * 4) + 30 * 4 * 10)
    # closed but for the floor: the projections of all walls cancel
    np.testing.assert_allclose(area[~roofs].sum(axis=0), 0.0, atol=1e-6)


def test_walls_face_away_from_the_house(town):
    tower = town.scenery.buildings[1]
    mesh, _ = building.buildings_surface((tower,))
    upright = np.abs(mesh.normals[:, 2]) < 0.1
    away = mesh.vertices[upright, :2] - [60.0, 30.0]
    assert (np.sum(away * mesh.normals[upright, :2], axis=1) > 0.0).all()


def test_facade_is_a_png_with_a_dark_window_in_a_light_wall():
    image = np.asarray(Image.open(io.BytesIO(building.facade(size=64))))
    assert image.shape == (64, 64, 3)
    assert image[32, 24].mean() < 150 < 240 < image[32, 2].mean()


def test_trees_stand_clear_of_street_pond_and_houses(town):
    x, y = tree.places(town)
    assert len(x) > 40
    assert (np.abs(y) > 3.5 + 0.5).all()
    assert not ((np.abs(x + 60) < 10) & (np.abs(y + 60) < 10)).any()
    np.testing.assert_array_equal(tree.places(town), tree.places(town))


def test_masts_stand_at_the_kerb_and_heads_hang_over_their_lanes(town):
    mesh = signal.masts(town)
    pole = mesh.vertices[mesh.vertices[:, 2] < 0.01]
    assert (pole[:, 1] < -3.5).all() and (pole[:, 0] > 150.0).all()
    _, y = signal.head_places(town)
    np.testing.assert_allclose(y, [-1.75, 1.75])
    assert mesh.vertices[:, 1].max() > 1.75


def test_sky_is_seen_from_inside():
    dome = sky()
    outward = np.sum(dome.normals[40:] * dome.vertices[40:], axis=1)
    assert (outward <= 0.0).mean() > 0.95


def test_shadows_fall_away_from_the_sun(town):
    shade = city.shade(town)
    tower = shade.vertices[shade.vertices[:, 0] > 20.0]
    thrown = -SUN[:2] / SUN[2] * 30.0
    tip = np.array([60.0, 30.0]) + thrown
    assert np.hypot(*(tower[:, :2] - tip).T).min() < 7.5
    assert shade.colors.shape[1] == 4 and 0.2 < shade.colors[0, 3] < 0.7


def test_layers_are_few_and_lie_apart(town):
    layers = city.layers(town)
    assert len({layer.name for layer in layers}) == len(layers) <= 12
    heights = sorted([city.GROUND, city.AREA, city.SPACE, city.ROAD, city.MARKING, city.SHADOW])
    assert np.diff(heights).min() > 0.015


def test_a_surface_of_one_colour_is_that_colour():
    triangle = surface([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], "#336699")
    np.testing.assert_allclose(triangle.colors, np.tile(linear("#336699"), (3, 1)), rtol=1e-6)
    np.testing.assert_allclose(triangle.normals, np.tile([0, 0, 1], (3, 1)))


@pytest.mark.parametrize(
    ("shape", "size", "volume"),
    [(obstacle.cone, (0.3, 0.3, 0.75), 0.003), (obstacle.barrier, (1.5, 0.5, 1.0), 0.02)],
    ids=["cone", "barrier"],
)
def test_objects_have_their_size_stand_on_the_road_and_are_red_and_white(shape, size, volume):
    body = shape()
    low, high = body.vertices.min(axis=0), body.vertices.max(axis=0)
    np.testing.assert_allclose(high - low, size, atol=0.01)
    assert low[2] == pytest.approx(0.0, abs=1e-6) and (low[:2] + high[:2]) == pytest.approx([0.0, 0.0], abs=1e-6)
    whole = solid(body)
    assert whole.is_winding_consistent and whole.volume > volume
    colours = {tuple(np.round(colour, 3)) for colour in body.colors}
    white = np.round(linear(obstacle.WHITE), 3)
    assert tuple(white.astype(np.float32).round(3)) in colours and len(colours) >= 3


def test_the_city_of_an_imported_map_is_kept_and_that_of_a_hand_made_one_is_not(town, tmp_path, monkeypatch):
    monkeypatch.setenv("STUDIO_CACHE", str(tmp_path))
    made = city.city(town)
    assert not list(tmp_path.rglob("*.pickle"))
    imported = replace(town, digest="0" * kept.DIGEST_LENGTH)
    first, second = city.city(imported), city.city(imported)
    assert len(list(tmp_path.rglob("*.pickle"))) == 1
    assert [layer.data for layer in made.layers] == [layer.data for layer in first.layers] == [layer.data for layer in second.layers]
    np.testing.assert_array_equal(first.trees, second.trees)


def test_walls_and_posts_have_their_sizes_and_stand_on_the_ground(town):
    wall = Wall("wall", np.array([[0.0, 10.0, 10.0], [0.0, 0.0, 5.0]]), 2.0, 0.25)
    mesh = upright.barrier(wall)
    assert (mesh.vertices[:, 2].min(), mesh.vertices[:, 2].max()) == (0.0, 2.0)
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(float) for i in range(3))
    normals = np.cross(b - a, c - a) / 2.0
    # two stretches, each with two long faces, two ends and a top; all face outward: the top up
    assert np.linalg.norm(normals, axis=1).sum() == pytest.approx(2 * 2.0 * 15.0 + 4 * 2.0 * 0.25 + 0.25 * 15.0)
    assert normals[:, 2].sum() == pytest.approx(0.25 * 15.0)
    post = upright.post(Post("bollard", 3.0, 4.0, 0.9, 0.16))
    assert post.vertices.mean(axis=0)[:2] == pytest.approx([3.0, 4.0], abs=0.01) and np.ptp(post.vertices[:, 2]) == pytest.approx(0.9)
