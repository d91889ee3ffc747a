"""All targets by name."""

import bags
import formats
import networks
import nodes
import page
import pictures
import simulator

TARGETS = {target.name: target
           for family in (formats, pictures, networks, bags, page, simulator, nodes)
           for target in family.TARGETS}
