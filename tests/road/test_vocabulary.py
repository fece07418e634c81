"""Whatever OpenStreetMap and OpenDRIVE define for cars is used or told: each key and element of these lists is tried on a small map.

The lists are those of the OpenStreetMap wiki (Map features: Highway, Lanes, Restrictions, Traffic calming, Barrier) and of ASAM
OpenDRIVE 1.8. Used is what changes lanes, limits, turns, lights, right of way or scenery; told is what stands in the report with its place.
"""

import pytest

from studio.road import load
from tests.road.plot import cross, skipped
from tests.road.test_opendrive import LINKED, crossing, lanes, road, written

# -- OpenStreetMap ---------------------------------------------------------------------------------

WAYS = """
highway=residential oneway=yes lanes=4 lanes:forward=2;lanes=3 lanes:backward=2;lanes=3 lanes:both_ways=1;lanes=3 lanes:reversible=1
lanes:bus=1;oneway=yes;lanes=3 lanes:psv=1;oneway=yes;lanes=3 turn:lanes=left|right;oneway=yes;lanes=2
turn:lanes:forward=left|through;lanes=4 turn=left turn:lanes:both_ways=left change:lanes=no|yes change=no placement=middle_of:1
width=7 width:lanes=3|3 width:carriageway=9 est_width=5 lane_markings=no divider=solid_line overtaking=no overtaking:forward=no
maxspeed=30 maxspeed:forward=30 maxspeed:backward=30 maxspeed:conditional=30@wet maxspeed:lanes=50|30 maxspeed:hgv=30 maxspeed:advisory=30
maxspeed:variable=yes maxspeed:practical=20 minspeed=30 maxspeed:type=DE:rural;maxspeed= source:maxspeed=DE:rural;maxspeed=
zone:maxspeed=DE:20;maxspeed= zone:traffic=DE:rural;maxspeed=
access=private access=destination vehicle=no motor_vehicle=permit motorcar=no motor_vehicle:backward=no vehicle:forward=no
motor_vehicle:conditional=no@night access:conditional=no@night oneway:conditional=yes@day oneway=reversible oneway=alternating oneway=-1
bus:lanes=designated|yes;oneway=yes;lanes=2 psv:lanes=designated|yes;oneway=yes;lanes=2 access:lanes=no|yes;oneway=yes;lanes=2
motorcar:lanes=no|yes hov:lanes=designated|yes taxi:lanes=designated|yes hgv:lanes=no|yes hov=designated hgv=no goods=no
maxweight=7.5 maxheight=3.2 maxlength=12 maxwidth=2.3 maxaxleload=5 maxweightrating=7.5 toll=yes motorroad=yes
priority_road=designated priority=forward traffic_sign=DE:265 traffic_calming=table hazard=animal_crossing incline=12% surface=gravel
smoothness=bad tracktype=grade3 ford=yes winter_road=yes ice_road=yes seasonal=summer flood_prone=yes embedded_rails=tram shoulder=right
cycleway=lane cycleway:right=lane busway=lane bicycle_road=yes cyclestreet=yes narrow=yes passing_places=yes tunnel=yes bridge=yes layer=1
covered=yes cutting=yes embankment=yes bridge:movable=bascule temporary=yes opening_hours=24/7 lanes=1 driving_side=left
maxheight:lanes=3|4 maxweight:hgv=7.5 maxspeed:towing=80 maxspeed:hgv:conditional=60@(weight>7.5) hgv:conditional=no@night hazmat=no lhv=no
trailer=no caravan=no motorhome=no coach=no tourist_bus=no maxaxleload:conditional=1@x incline:up=12% surface:lanes=gravel|asphalt
parking:right:restriction=no_stopping parking:left:maxstay=1h junction=jughandle change:lanes:forward=no|yes
access:lanes:forward=no|yes;lanes=4
overtaking:conditional=no@night lanes:conditional=3@day turn:lanes:conditional=left@day junction=roundabout name=Weg
""".split()
NODES = """
highway=traffic_signals highway=mini_roundabout highway=turning_circle highway=turning_loop highway=passing_place highway=speed_camera
highway=toll_gantry highway=crossing;crossing=zebra traffic_signals=blinker;highway=traffic_signals traffic_calming=bump barrier=bollard
barrier=gate barrier=lift_gate barrier=block barrier=toll_booth motor_vehicle=no access=private railway=level_crossing hazard=curve
highway=stop highway=give_way highway=stop;direction=backward
ford=yes maxheight=3 maxwidth=2 maxweight=3 traffic_sign=DE:205 toll=yes priority=backward maxspeed=30 bridge:movable=swing
""".split()
RELATIONS = """
restriction=no_left_turn restriction=only_straight_on restriction:conditional=no_left_turn@day restriction:motorcar=no_left_turn
restriction=no_tea type=connectivity type=restriction:bus restriction=no_left_turn;hour_on=7
""".split()
OTHERS = "raceway construction proposed service track road busway escape bus_guideway rest_area services".split()


def tags(text):
    """ "a=b;c=d" as tags; a value may have a bar."""
    return dict(part.split("=", 1) for part in text.split(";"))


def found(network):
    """What is built, but for the places."""
    own = [(each.road, each.index, round(each.width, 2), round(each.speed, 2), each.open, round(each.length, 1)) for each in network.lanes]
    roads = [(each.kind, each.name, float(network.lanes_of(each.id)[0].height.max())) for each in network.roads.values()]
    ways = [(c.from_lane, c.to_lane, c.link, c.right_of_way, c.yields) for c in network.connections]
    return own, roads, ways, len(network.scenery.crossings), network.drive_side, network.report.guesses


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("STUDIO_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield load(cross(tmp_path_factory.mktemp("plain") / "plain.osm"))


def is_used_or_told(network, plain, element):
    told = [line for line in skipped(network) if f"at {element}" in line]
    assert told or found(network) != found(plain)


@pytest.mark.parametrize("text", WAYS)
def test_a_tag_of_a_way_is_used_or_told(tmp_path, own_cache, plain, text):
    is_used_or_told(load(cross(tmp_path / "map.osm", west=tags(text))), plain, "way 11")


@pytest.mark.parametrize("text", NODES)
def test_a_tag_of_a_node_is_used_or_told(tmp_path, own_cache, plain, text):
    is_used_or_told(load(cross(tmp_path / "map.osm", middle=tags(text))), plain, "node 1")


@pytest.mark.parametrize("text", RELATIONS)
def test_a_relation_is_used_or_told(tmp_path, own_cache, plain, text):
    members = (("way", 11, "from"), ("node", 1, "via"), ("way", 14, "to"))
    is_used_or_told(load(cross(tmp_path / "map.osm", relations={21: (members, tags(text))})), plain, "relation 21")


@pytest.mark.parametrize("kind", OTHERS)
def test_another_class_of_ways_is_told(tmp_path, own_cache, kind):
    network = load(cross(tmp_path / "map.osm", west={"highway": kind}))
    assert any(f"highway={kind}" in line for line in skipped(network))


# -- OpenDRIVE -------------------------------------------------------------------------------------

CUBIC = 's="10" a="0.1" b="0" c="0" d="0"'
ROAD = {  # within <road>, beside its plan view
    "type": '<type s="0" type="motorway"/>', "speed": '<type s="0" type="town"><speed max="20" unit="km/h"/></type>',
    "elevation": f"<elevationProfile><elevation {CUBIC}/></elevationProfile>",
    "superelevation": f"<lateralProfile><superelevation {CUBIC}/></lateralProfile>",
    "crossfall": f'<lateralProfile><crossfall side="both" {CUBIC}/></lateralProfile>',
    "shape": f'<lateralProfile><shape t="0" {CUBIC}/></lateralProfile>',
    "crossSectionSurface": "<lateralProfile><crossSectionSurface/></lateralProfile>",
    "object": '<objects><object id="1" type="barrier" s="5" t="3"/></objects>',
    "bridge": '<objects><bridge id="1" s="5" length="9"/></objects>',
    "tunnel": '<objects><tunnel id="1" s="5" length="9"/></objects>',
    "objectReference": '<objects><objectReference id="1" s="5"/></objects>',
    "CRG": '<surface><CRG file="a.crg" sStart="0" sEnd="9"/></surface>', "switch": '<railroad><switch id="1" name="a"/></railroad>',
    "light": '<signals><signal id="1" s="150" t="0" dynamic="yes" orientation="+" type="1000001"/></signals>',
    "other sign": '<signals><signal id="1" s="5" t="0" dynamic="no" orientation="+" type="274" country="DE"/></signals>',
    "dependency": '<signals><signal id="1" s="150" t="0" dynamic="yes" type="1000001"><dependency id="2"/></signal></signals>',
    "include": '<include file="other.xodr"/>', "unknown": "<hovercraft/>", "rule": "",
}  # fmt: skip
LANE = {  # within a <lane>
    name: f"<{name} sOffset='0'/>" for name in ("roadMark", "material", "visibility", "height", "rule")
} | {"access": '<access sOffset="0" rule="deny" restriction="passengerCar"/>', "of others": '<access rule="deny" restriction="truck"/>',
     "speed": '<speed sOffset="0" max="5"/>', "unknown": "<rail/>"}  # fmt: skip
ATTRIBUTES = {
    'direction="reversed"', 'direction="both"', 'dynamicLaneDirection="true"', 'dynamicLaneType="true"', 'advisory="inner"',
    'roadWorks="true"', 'direction="sideways"',
}  # fmt: skip
JUNCTION = {
    name: f"<{name}/>" for name in ("controller", "surface", "planView", "elevationGrid", "boundary", "crossPath", "roadSection", "lantern")
} | {"priority": '<priority high="w2" low="w1"/>', "flawed priority": '<priority high="x" low="y"/>'}
TOP = {
    "controller": '<controller id="c"/>', "station": '<station id="s" name="s"/>', "include": '<include file="x"/>', "unknown": "<zoo/>",
    "junctionGroup": '<junctionGroup id="g" type="complexJunction"/>', "virtual": '<junction id="v" type="virtual" mainRoad="in"/>',
}  # fmt: skip


@pytest.fixture
def bare(tmp_path, own_cache):
    (tmp_path / "bare").mkdir()
    return load(written(tmp_path / "bare", *crossing()))


def is_one_of_both(network, bare):
    assert found(network) != found(bare) or len(skipped(network)) > len(skipped(bare))
    assert all(" at " in line for line in skipped(network))


@pytest.mark.parametrize("name", ROAD)
def test_an_element_of_a_road_is_used_or_told(tmp_path, bare, name):
    first, *others = crossing(lights=ROAD[name])
    is_one_of_both(load(written(tmp_path, first.replace("<road ", '<road rule="RIGHT" ') if name == "rule" else first, *others)), bare)


@pytest.mark.parametrize("name", LANE)
def test_an_element_of_a_lane_is_used_or_told(tmp_path, bare, name):
    first, *others = crossing()
    network = load(written(tmp_path, first.replace("<width ", LANE[name] + "<width "), *others))
    is_one_of_both(network, bare)
    assert [lane.open for lane in network.lanes] != [lane.open for lane in bare.lanes] if name == "access" else True


@pytest.mark.parametrize("text", sorted(ATTRIBUTES))
def test_an_attribute_of_a_lane_is_used_or_told(tmp_path, bare, text):
    first, *others = crossing()
    is_one_of_both(load(written(tmp_path, first.replace("<lane ", f"<lane {text} "), *others)), bare)


@pytest.mark.parametrize("name", JUNCTION)
def test_an_element_of_a_junction_is_used_or_told(tmp_path, bare, name):
    *roads, junction = crossing()
    network = load(written(tmp_path, *roads, junction.replace("</junction>", JUNCTION[name] + "</junction>")))
    if name != "priority":  # of two ways that part nobody waits
        is_one_of_both(network, bare)


@pytest.mark.parametrize("name", TOP)
def test_what_stands_beside_the_roads_is_told(tmp_path, bare, name):
    is_one_of_both(load(written(tmp_path, *crossing(), TOP[name])), bare)


def test_links_and_neighbours_are_used_or_told(tmp_path, own_cache):
    section = f'<laneSection s="0">{lanes("driving", inner=LINKED.format(-1))}</laneSection>'
    link = '<neighbor side="left" elementId="2" direction="same"/><successor elementType="road" elementId="9" contactPoint="start"/>'
    lines = skipped(load(written(tmp_path, road("1", sections=section, link=link))))
    assert any("<neighbor>" in line for line in lines) and any("to road 9" in line for line in lines)
