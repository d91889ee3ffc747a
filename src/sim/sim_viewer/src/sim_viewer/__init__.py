"""The page in the browser: a server between ROS and the modules in web/."""
