"""The server: page, REST, live runs, and the scene, on one origin."""
