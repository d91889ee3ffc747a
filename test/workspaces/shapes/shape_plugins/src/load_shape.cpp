#include <pluginlib/class_loader.h>
#include <shape_plugins/shape.h>
#include <cstdio>

int main() {
  pluginlib::ClassLoader<shape_plugins::Shape> loader("shape_plugins", "shape_plugins::Shape");
  std::printf("%d sides\n", loader.createInstance("shape_plugins::Square")->sides());
  return 0;
}
