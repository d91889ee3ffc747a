"""Reading URDF, SDF, xacro and OGRE material files into `bullet_sim.description`."""
