"""The only room that knows PyBullet's integers: a client, and bodies made of descriptions."""
