#include <controller_interface/controller.h>
#include <hardware_interface/joint_command_interface.h>
