"""Test rigs: a part or a whole vehicle by itself, driven by a table of inputs."""
