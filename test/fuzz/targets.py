"""All targets by name."""

import formats
import maps
import meshes

TARGETS = {target.name: target for family in (formats, meshes, maps)
           for target in family.TARGETS}
