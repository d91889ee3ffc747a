"""The web page's server, which connects ROS with the browser's modules in web/."""
