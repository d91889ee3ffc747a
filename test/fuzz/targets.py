"""All targets by name."""

import bags
import formats
import forms
import maps
import meshes
import networks
import nodes
import page
import pictures
import simulator

TARGETS = {target.name: target
           for family in (formats, meshes, maps, pictures, networks, bags, forms, page, simulator,
                          nodes)
           for target in family.TARGETS}
