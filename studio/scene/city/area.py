"""Ground of other colours: parks, water, squares."""

from collections import defaultdict

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from studio.road.network import Network
from studio.road.network.plane import polygon
from studio.scene.city.mesh import Mesh, flat


def area_meshes(network: Network, opened: BaseGeometry) -> dict[str, Mesh]:
    """Ground of other colours, each kind as one mesh; none lies on another, nor where the ground is open."""
    forms = area_forms(network)
    return {kind: flat(form if opened.is_empty else form.difference(opened)) for kind, form in forms.items()}


def area_forms(network: Network) -> dict[str, BaseGeometry]:
    """All areas by kind, cut where they overlap: the smaller one lies on the larger one, a pond in its park."""
    areas = network.scenery.areas
    forms = np.array([polygon(area) for area in areas])
    tree = shapely.STRtree(forms)
    size = shapely.area(forms) if len(forms) else np.empty(0)
    rank = np.empty(len(forms))
    rank[np.argsort(-size, kind="stable")] = np.arange(len(forms))
    shown = defaultdict(list)
    for i, (area, form) in enumerate(zip(areas, forms, strict=True)):
        above = [forms[j] for j in tree.query(form, predicate="intersects") if rank[j] > rank[i]]
        shown[area.kind].append(form.difference(shapely.union_all(above)) if above else form)
    return {kind: shapely.union_all(pieces) for kind, pieces in shown.items()}
