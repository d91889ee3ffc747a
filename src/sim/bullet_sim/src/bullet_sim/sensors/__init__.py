"""Pure reads of the world: each sensor samples into a frozen reading."""
