#include "shape_gazebo/plugin.h"

namespace gazebo {
void ShapePlugin::Load(physics::ModelPtr, sdf::ElementPtr) {}
int shape_plugin_version() { return 1; }
GZ_REGISTER_MODEL_PLUGIN(ShapePlugin)
}  // namespace gazebo
