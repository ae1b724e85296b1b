"""`bearingjax schema`."""

import json
from argparse import Namespace


def run(options: Namespace) -> None:
    """Print the JSON Schema of scene files, with which editors complete and check them,
    or the keys of their tables with units, ranges and defaults."""
    from .scene_schema import key_guide, scene_schema

    if options.keys is None:
        print(json.dumps(scene_schema(), indent=1, ensure_ascii=False), flush=True)
    else:
        print(key_guide(options.keys), end="", flush=True)
