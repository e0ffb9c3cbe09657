"""MIMo's sense of touch."""
