"""The ground as triangles: right way up, whole, and painted as streets are."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from studio.road.network import Building
from studio.road.network.outline import road_form
from studio.scene.city import line, marking
from studio.scene.city.area import area_meshes
from studio.scene.city.mesh import flat
from studio.scene.city.shadow import cast, footprint, shadow_mesh

SQUARE = np.array([[0.0, 10.0, 10.0, 0.0], [0.0, 0.0, 6.0, 6.0]])
SUN = (-0.45, 0.35, -0.82)


@pytest.fixture(scope="module")
def flats(place):
    areas = area_meshes(place, shapely.Polygon())
    return {
        "green": areas["green"],
        "water": areas["water"],
        "road": flat(road_form(place)),
        "marking": marking.marking_mesh(place, road_form(place), marking.marks_of(place)),
        "shadow": shadow_mesh(place, sun=SUN),
    }


def normals(mesh):
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(float) for i in range(3))
    return np.cross(b - a, c - a) / 2.0


def test_meshes_are_what_the_scene_expects(flats, place):
    for mesh in flats.values():
        assert mesh.vertices.dtype == np.float32 and mesh.vertices.shape[1] == 3
        assert mesh.faces.dtype == np.uint32 and mesh.faces.max() < len(mesh.vertices)
        assert np.isfinite(mesh.vertices).all()


def test_flat_things_look_up(flats):
    for mesh in flats.values():
        assert (normals(mesh)[:, 2] > -1e-3).all()  # slivers of float32 may be flat


def test_triangles_cover_the_road_once(place, flats):
    assert normals(flats["road"])[:, 2].sum() == pytest.approx(road_form(place).area, rel=1e-3)


def test_the_road_is_one_piece_with_the_circle_open(place):
    form = road_form(place)
    assert form.geom_type == "Polygon" and not form.contains(shapely.Point(-7.0, 12.0))
    for lane in place.lanes:
        assert form.buffer(0.3).contains(shapely.LineString(lane.centre.T))


def test_every_car_drives_on_asphalt(place, paths):
    form = road_form(place)
    shapely.prepare(form)
    for one in paths:
        assert shapely.contains_xy(form, *one.points[:2, 1:-1]).all()


def test_markings_lie_on_the_road(place):
    bare = replace(place, scenery=replace(place.scenery, spaces=place.scenery.spaces[:, :0]))  # spaces lie beside it
    mesh = marking.marking_mesh(bare, road_form(bare), marking.marks_of(bare))
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    form = road_form(place).buffer(0.2)
    shapely.prepare(form)
    inside = shapely.contains_xy(form, middles[:, 0], middles[:, 1])
    assert inside.mean() > 0.999


def test_a_dash_is_three_metres_every_nine():
    dashes = list(line.dashes(shapely.LineString([(0.0, 0.0), (90.0, 0.0)])))
    starts = [dash.bounds[0] for dash in dashes]
    assert np.diff(starts) == pytest.approx(9.0)
    assert [dash.area for dash in dashes] == pytest.approx([3.0 * line.LINE_WIDTH] * len(dashes))


def test_there_is_a_stop_line_before_every_signal(place):
    signals = place.signals
    for link in range(len(signals)):
        bar = line.stop_line(place, link)
        assert bar.area == pytest.approx(0.5 * signals.link_width[link])
        front = shapely.Point(signals.link_x[link], signals.link_y[link])
        assert bar.distance(front) < 1e-6 and bar.contains(shapely.Point(
            front.x - 0.2 * np.cos(signals.link_heading[link]), front.y - 0.2 * np.sin(signals.link_heading[link])
        ))  # fmt: skip


def test_a_shadow_is_as_long_as_the_sun_is_low():
    """Light that falls 3 down for 4 across casts a shadow of 4/3 of the height, here to the east."""
    building = Building(SQUARE, (), 12.0, 0.0, "")
    form = cast(footprint(building), building, (0.8, 0.0, -0.6))
    assert form.bounds == pytest.approx((0.0, 0.0, 26.0, 6.0)) and form.area == pytest.approx(26.0 * 6.0)


def test_a_part_in_the_air_throws_its_shadow_beside_itself():
    building = Building(SQUARE, (), 12.0, 9.0, "")
    form = cast(footprint(building), building, (0.8, 0.0, -0.6))
    assert form.bounds == pytest.approx((12.0, 0.0, 26.0, 6.0))


def test_a_place_without_scenery_has_empty_meshes(straight):
    assert len(shadow_mesh(straight, sun=SUN).faces) == 0
    assert (
        len(flat(road_form(straight)).faces) > 0
        and len(marking.marking_mesh(straight, road_form(straight), marking.marks_of(straight)).faces) > 0
    )
