#pragma once
namespace shape_plugins {
class Shape {
 public:
  virtual ~Shape() {}
  virtual int sides() const = 0;
};
}  // namespace shape_plugins
