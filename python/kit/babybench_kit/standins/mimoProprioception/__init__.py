"""MIMo's proprioception."""
