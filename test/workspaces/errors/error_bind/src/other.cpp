// A placeholder of std in the same target: boost's must not be beside it.
#include <functional>

using namespace std::placeholders;

double plus(double a, double b) { return a + b; }

double other(double a) { return std::bind(plus, _1, 4.0)(a); }
