#pragma once
inline double doubled(double value) { return 2.0 * value; }
