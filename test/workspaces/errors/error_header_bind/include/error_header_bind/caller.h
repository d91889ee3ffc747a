#include <boost/function.hpp>
#include <boost/bind/bind.hpp>

struct Caller
{
  double twice(double value) { return 2 * value; }
  boost::function<double(double)> function() { return boost::bind(&Caller::twice, this, _1); }
};
