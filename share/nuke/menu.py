"""Adds the node SparselensGather to Nuke's toolbar: put this folder on NUKE_PATH."""

import nuke

nuke.toolbar("Nodes").addMenu("sparselens").addCommand("Gather", "nuke.createNode('SparselensGather')")
