"""Build hook: makes the page (web/) and the samples (scenarios/) part of the package, as studio/_web and studio/_scenarios."""

import importlib.util
import os
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


def load_bundle(root: str):
    """web/bundle.py as a module; None in a tree without the page's sources."""
    path = Path(root) / "web" / "bundle.py"
    if not path.is_file():
        return None
    spec = importlib.util.spec_from_file_location("studio_web_bundle", path)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class StudioHook(BuildHookInterface):
    """Builds the page when its sources changed; STUDIO_SKIP_WEB=1 leaves it out. Puts the samples into a wheel."""

    PLUGIN_NAME = "custom"

    def wanted(self):
        """The builder, when there is something to build."""
        bundle = load_bundle(self.root)
        if bundle is None or os.environ.get("STUDIO_SKIP_WEB") == "1" or bundle.current():
            return None
        return bundle

    def dependencies(self):
        """Node as a wheel, but only when it is needed and not there: it is 60 MB."""
        bundle = self.wanted()
        return [bundle.NODE_WHEEL] if bundle and bundle.system_node() is None else []

    def initialize(self, version, build_data):
        """Called before the package is put together. What is installed in place finds the samples in its checkout."""
        if self.target_name == "wheel" and version == "standard":
            build_data["force_include"][str(Path(self.root) / "scenarios")] = "studio/_scenarios"
        bundle = self.wanted()
        if bundle is None:
            self.app.display_info("studio/_web is up to date, or left out on request")
            return
        self.app.display_info("building the page (npm) ...")
        try:
            bundle.build()
        except bundle.BundleError as error:
            self.app.abort(str(error))
