#!/usr/bin/env python2
print "Python 2 prints without brackets"
