#include <gazebo/gazebo.hh>

class Plugin : public gazebo::ModelPlugin {};
