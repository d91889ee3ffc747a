#pragma once
#include <string>
// How many links a URDF text has; -1 if it is no URDF.
int links_in(const std::string& text);
