"""The services of /gazebo: each handler runs in the loop, and turns an exception into a status."""
