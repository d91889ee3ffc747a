#pragma once
constexpr double kLinear = 0.3;
