"""Small maps of OpenStreetMap, drawn in metres."""

from xml.sax.saxutils import quoteattr

import numpy as np

METRE = 1.0 / 111_194.9  # [deg] of latitude on a sphere of 6371 km
BERLIN, LONDON, ILLINOIS = (52.5, 13.4), (51.5, -1.5), (40.1, -89.0)


def tags(of):
    return "".join(f"<tag k={quoteattr(key)} v={quoteattr(value)}/>" for key, value in of.items())


def plot(target, nodes, ways, relations=None, *, centre=BERLIN):
    """Writes a map: nodes {id: (x, y) or (x, y, tags)} [m], ways {id: (nodes, tags)}, relations {id: (members, tags)}.

    A way without highway is a secondary road; members are (type, id, role).
    """
    lines = ['<?xml version="1.0"?><osm version="0.6">']
    for name, (x, y, *own) in nodes.items():
        latitude, longitude = centre[0] + y * METRE, centre[1] + x * METRE / np.cos(np.radians(centre[0]))
        lines.append(f'<node id="{name}" version="1" lat="{latitude:.8f}" lon="{longitude:.8f}">{tags(own[0] if own else {})}</node>')
    for name, (line, own) in ways.items():
        usual = {"highway": "secondary", "maxspeed": "50", "lanes": "1" if own.get("oneway") == "yes" else "2"}
        refs = "".join(f'<nd ref="{node}"/>' for node in line)
        kept = {key: value for key, value in (usual | own).items() if value}
        lines.append(f'<way id="{name}" version="1">{refs}{tags(kept)}</way>')
    for name, (members, own) in (relations or {}).items():
        inner = "".join(f'<member type="{form}" ref="{ref}" role="{role}"/>' for form, ref, role in members)
        lines.append(f'<relation id="{name}" version="1">{inner}{tags({"type": "restriction"} | own)}</relation>')
    target.write_text("\n".join([*lines, "</osm>"]), encoding="utf-8")
    return target


def cross(target, *, west=None, east=None, south=None, north=None, middle=None, relations=None, centre=BERLIN, everywhere=None):
    """Four roads of 200 m that meet: 11 from the west and 13 from the south lead to node 1, 12 to the east and 14 to the north away."""
    nodes = {1: (0, 0, middle or {}), 2: (-200, 0), 3: (200, 0), 4: (0, -200), 5: (0, 200)}
    ends = {11: ([2, 1], west), 12: ([1, 3], east), 13: ([4, 1], south), 14: ([1, 5], north)}
    ways = {name: (line, (everywhere or {}) | (own or {})) for name, (line, own) in ends.items()}
    return plot(target, nodes, ways, relations, centre=centre)


def straight(target, *own, centre=BERLIN, length=400):
    """Ways one behind the other along x, from west to east, with these tags: 11, 12, …"""
    nodes = {i + 1: (i * length, 0) for i in range(len(own) + 1)}
    return plot(target, nodes, {11 + i: ([i + 1, i + 2], each) for i, each in enumerate(own)}, centre=centre)


def turns(network):
    """The pairs of roads of which one leads to the other, but for turning back."""
    lanes = network.lanes
    return {(lanes[c.from_lane].road, lanes[c.to_lane].road) for c in network.connections if c.direction != "turn"}


def skipped(network):
    """What was left out: kind, what and element, in one line each."""
    return [f"{each.kind}: {each.what} at {each.where} ({each.reason})" for each in network.report.skipped]


def guessed(network):
    """What was guessed, in one line each."""
    return [f"{each.kind}: {each.what} at {each.where} ({each.source})" for each in network.report.guesses]
