"""All targets by name."""

import bags
import formats
import forms
import maps
import meshes
import networks
import pictures

TARGETS = {target.name: target
           for family in (formats, meshes, maps, pictures, networks, bags, forms)
           for target in family.TARGETS}
