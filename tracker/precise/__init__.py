"""An error-state Kalman filter on the manifold: the estimator that a picture can be hung on."""
