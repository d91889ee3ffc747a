#include <shape_library/links.h>
#include <urdf/model.h>

int links_in(const std::string& text) {
  urdf::Model model;
  return model.initString(text) ? static_cast<int>(model.links_.size()) : -1;
}
