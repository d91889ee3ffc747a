# As upstream's: who depends on gazebo_dev has found Gazebo.
find_package(gazebo REQUIRED)
