"""The lane's world: crossings and scenery, the painted ground, the files."""
