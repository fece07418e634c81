"""Meshes: right way up, whole, and in layers that do not flicker."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from studio.road import marking, surface
from studio.road.network import Building

SQUARE = np.array([[0.0, 10.0, 10.0, 0.0], [0.0, 0.0, 6.0, 6.0]])
YARD = np.array([[4.0, 4.0, 6.0, 6.0], [2.0, 4.0, 4.0, 2.0]])


@pytest.fixture(scope="module")
def flats(place):
    areas = surface.area_meshes(place)
    return {
        "ground": surface.ground_mesh(place),
        "green": areas["green"],
        "water": areas["water"],
        "road": surface.road_mesh(surface.road_form(place)),
        "marking": marking.marking_mesh(place, surface.road_form(place)),
        "shadow": surface.shadow_mesh(place),
    }


def normals(mesh):
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(float) for i in range(3))
    return np.cross(b - a, c - a) / 2.0


def volume(mesh):
    """Enclosed by a mesh whose faces look outward (divergence theorem) [m³]."""
    a, b, c = (mesh.vertices[mesh.faces[:, i]].astype(float) for i in range(3))
    return (np.cross(a, b) * c).sum() / 6.0


def test_meshes_are_what_the_scene_expects(flats, place):
    for mesh in (*flats.values(), surface.building_mesh(place)):
        assert mesh.vertices.dtype == np.float32 and mesh.vertices.shape[1] == 3
        assert mesh.faces.dtype == np.uint32 and mesh.faces.max() < len(mesh.vertices)
        assert np.isfinite(mesh.vertices).all()


def test_flat_things_look_up(flats):
    for mesh in flats.values():
        assert (normals(mesh)[:, 2] > -1e-3).all()  # slivers of float32 may be flat


def test_layers_are_apart(flats):
    heights = sorted({float(height) for mesh in flats.values() for height in np.unique(mesh.vertices[:, 2])})
    assert len(heights) == 5 and np.diff(heights).min() >= 0.05


def test_triangles_cover_the_road_once(place, flats):
    assert normals(flats["road"])[:, 2].sum() == pytest.approx(surface.road_form(place).area, rel=1e-3)


def test_the_road_is_one_piece_with_the_circle_open(place):
    form = surface.road_form(place)
    assert form.geom_type == "Polygon" and not form.contains(shapely.Point(-7.0, 12.0))
    for lane in place.lanes:
        assert form.buffer(0.3).contains(shapely.LineString(lane.centre.T))


def test_every_car_drives_on_asphalt(place, paths):
    form = surface.road_form(place)
    shapely.prepare(form)
    for one in paths:
        assert shapely.contains_xy(form, *one.points[:2, 1:-1]).all()


def test_markings_lie_on_the_road(place):
    bare = replace(place, scenery=replace(place.scenery, spaces=place.scenery.spaces[:, :0]))  # spaces lie beside it
    mesh = marking.marking_mesh(bare, surface.road_form(bare))
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    form = surface.road_form(place).buffer(0.2)
    shapely.prepare(form)
    inside = shapely.contains_xy(form, middles[:, 0], middles[:, 1])
    assert inside.mean() > 0.999


def test_a_dash_is_three_metres_every_nine():
    dashes = list(surface.dashes(shapely.LineString([(0.0, 0.0), (90.0, 0.0)])))
    starts = [dash.bounds[0] for dash in dashes]
    assert np.diff(starts) == pytest.approx(9.0)
    assert [dash.area for dash in dashes] == pytest.approx([3.0 * surface.LINE_WIDTH] * len(dashes))


def test_there_is_a_stop_line_before_every_signal(place):
    signals = place.signals
    for link in range(len(signals)):
        bar = surface.stop_line(place, link)
        assert bar.area == pytest.approx(0.5 * signals.link_width[link])
        front = shapely.Point(signals.link_x[link], signals.link_y[link])
        assert bar.distance(front) < 1e-6 and bar.contains(shapely.Point(
            front.x - 0.2 * np.cos(signals.link_heading[link]), front.y - 0.2 * np.sin(signals.link_heading[link])
        ))  # fmt: skip


@pytest.mark.parametrize(("holes", "area"), [((), 60.0), ((YARD,), 56.0)])
@pytest.mark.parametrize("base", [0.0, 4.0])
def test_a_building_encloses_its_volume(holes, area, base):
    mesh = surface.solid(Building(SQUARE, holes, 12.0, base, ""))
    floor = surface.flat(shapely.Polygon(SQUARE.T, [hole.T for hole in holes]), 0.0, up=False)
    closed = mesh if base else surface.merged([mesh, floor])
    assert volume(closed) == pytest.approx(area * (12.0 - base))
    assert np.linalg.norm(normals(closed), axis=1).sum() == pytest.approx(
        2 * area + (12.0 - base) * (32.0 + 8.0 * len(holes))
    )


def test_faces_of_a_building_share_no_vertices_across_edges():
    mesh = surface.solid(Building(SQUARE, (), 12.0, 0.0, ""))
    facing = normals(mesh) / np.linalg.norm(normals(mesh), axis=1)[:, None]
    for vertex in range(len(mesh.vertices)):
        own = facing[(mesh.faces == vertex).any(axis=1)]
        assert np.abs(own - own[0]).max() < 1e-6


def test_the_buildings_of_a_place_by_colour_are_all_of_them(place):
    by_colour = surface.building_meshes(place)
    assert sum(len(mesh.faces) for mesh in by_colour.values()) == len(surface.building_mesh(place).faces)
    assert "#ffd700" in by_colour  # the gilded cannons of the column


def test_a_shadow_is_as_long_as_the_sun_is_low():
    """Light that falls 3 down for 4 across casts a shadow of 4/3 of the height, here to the east."""
    building = Building(SQUARE, (), 12.0, 0.0, "")
    form = surface.cast(surface.footprint(building), building, (0.8, 0.0, -0.6))
    assert form.bounds == pytest.approx((0.0, 0.0, 26.0, 6.0)) and form.area == pytest.approx(26.0 * 6.0)


def test_a_part_in_the_air_throws_its_shadow_beside_itself():
    building = Building(SQUARE, (), 12.0, 9.0, "")
    form = surface.cast(surface.footprint(building), building, (0.8, 0.0, -0.6))
    assert form.bounds == pytest.approx((12.0, 0.0, 26.0, 6.0))


def test_a_place_without_scenery_has_empty_meshes(straight):
    assert len(surface.building_mesh(straight).faces) == len(surface.shadow_mesh(straight).faces) == 0
    assert len(surface.road_mesh(surface.road_form(straight)).faces) > 0 and len(marking.marking_mesh(straight, surface.road_form(straight)).faces) > 0
