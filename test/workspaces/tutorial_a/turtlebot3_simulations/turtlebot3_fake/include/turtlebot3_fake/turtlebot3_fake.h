#pragma once
constexpr char kOdomFrame[] = "odom";
