#include <pluginlib/class_list_macros.h>
#include <shape_plugins/shape.h>

namespace shape_plugins {
class Square : public Shape {
 public:
  int sides() const override { return 4; }
};
}  // namespace shape_plugins

PLUGINLIB_EXPORT_CLASS(shape_plugins::Square, shape_plugins::Shape)
