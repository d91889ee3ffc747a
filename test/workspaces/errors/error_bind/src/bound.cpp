#include <cstdio>
#include <boost/bind/bind.hpp>
#include <boost/function.hpp>
#include "error_bind/half.h"
// using namespace std::placeholders;

double minus(double a, double b) { return a - b; }
double other(double a);

int main()
{
  boost::function<double(double)> by_two = boost::bind<double>(&minus, _1, 2.0);
  std::printf("bound %.1f\n", half(other(by_two(10.0))));
}
