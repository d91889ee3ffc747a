"""The lane's world: what is on and beside it, its painted ground, its files."""
