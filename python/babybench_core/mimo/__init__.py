"""What runs under the names of the Python kit."""
