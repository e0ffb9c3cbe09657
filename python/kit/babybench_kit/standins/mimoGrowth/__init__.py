"""MIMo at other ages."""
