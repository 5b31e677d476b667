#pragma once
#include <cstdlib>
inline double tun(const char* n, double d) { const char* s = getenv(n); return s ? atof(s) : d; }
#define TUN(name, d) ([] { static const double tun_value_ = tun(name, d); return tun_value_; }())
