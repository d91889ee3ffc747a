namespace gazebo {
int shape_plugin_version();
}
int main() { return gazebo::shape_plugin_version(); }
