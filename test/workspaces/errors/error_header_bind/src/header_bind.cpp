#include "error_header_bind/caller.h"

double called() { return Caller().function()(2); }
