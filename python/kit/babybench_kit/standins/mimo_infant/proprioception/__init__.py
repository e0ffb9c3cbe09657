"""MIMo 3's proprioception."""
