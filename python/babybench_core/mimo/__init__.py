"""The modules that run under the names of the Python kit."""
