#include <nav_core/base_global_planner.h>
