"""The 3D scene: meshes, and the projection of a map, its signals and its vehicles onto a viser server."""
