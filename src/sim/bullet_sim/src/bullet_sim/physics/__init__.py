"""The only package that uses PyBullet's integers: a client, and bodies built from descriptions."""
